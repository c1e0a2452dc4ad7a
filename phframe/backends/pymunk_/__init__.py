"""Physics in the plane with pymunk."""
