"""Measures phframe: how planners do on the suites, and what planning costs beside the bare engine."""
