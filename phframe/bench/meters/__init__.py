"""Meters for developers: planning, simulation and motion planning beside bare loops of the same steps."""
