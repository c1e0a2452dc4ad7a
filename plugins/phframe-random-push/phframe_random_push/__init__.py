"""Random pushes for phframe. Only the hook is here: the planner is imported when somebody asks for it."""

from phframe.registry import Extension, Kind, hookimpl


@hookimpl
def phframe_extensions() -> list[Extension]:
    """One planner."""
    return [
        Extension(
            Kind.PLANNER,
            "random-push",
            "phframe_random_push.random_push:RandomPush",
            "Sweeps a random obstacle in a random direction: the floor that every other planner must beat",
            api_version=2,
        )
    ]
