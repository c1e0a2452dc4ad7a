"""Topology engines, one file per engine. Importing this package imports none of them."""
