"""The results of a bench as files for other programs."""
