"""The command line: one small file per command group; each imports what it needs when it runs."""
