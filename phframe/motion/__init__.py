"""Motion planning: kinematics, collision checking, Cartesian path following, OMPL, time parametrisation."""
