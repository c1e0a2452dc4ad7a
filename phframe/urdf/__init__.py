"""Robots as links and joints: one model, one reader, one writer of URDF."""
