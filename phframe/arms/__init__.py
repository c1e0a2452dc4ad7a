"""Robot arms: one file or folder per robot, each an ``ArmModel``."""
