"""Physics in 3D with PyBullet."""
