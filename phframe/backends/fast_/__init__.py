"""Physics in the plane, compiled by numba: the engine to plan in."""
