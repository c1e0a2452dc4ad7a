"""What kinodynamic planners share: steered motions, search among controls, and the paths that come of them."""
