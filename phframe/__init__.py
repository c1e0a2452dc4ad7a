"""phframe plans how a robot arm pushes through clutter, with persistent homology."""
