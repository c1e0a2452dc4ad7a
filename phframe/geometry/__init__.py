"""Planar geometry that is nobody's method: outlines, clearance, the shelf as boxes."""
