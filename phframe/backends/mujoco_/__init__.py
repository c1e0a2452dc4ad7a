"""Physics in 3D with MuJoCo."""
