"""What runs the trials of a bench elsewhere than on this machine."""
