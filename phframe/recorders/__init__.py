"""Observers that write down what an episode does, and drawings of scenes.

They read scenes, plans, steps and episodes; nothing of what they read knows of them.
"""
