"""Observers that write down what an episode does. They read plans, steps and episodes; nothing knows of them."""
