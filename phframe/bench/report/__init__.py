"""The report of a bench: one page that needs no network, tables as Markdown or JSON, figures as PNG and PDF."""
