"""The planners: one file each, made of what is in pushing/."""
