"""YAML files that people write: read with the line of everything in them, and complained of in their words."""
