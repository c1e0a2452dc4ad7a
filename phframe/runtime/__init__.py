"""Worlds, episodes and ``solve``: what carries plans out."""
