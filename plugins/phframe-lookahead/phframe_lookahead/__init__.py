"""One-step lookahead for phframe. Only the hook is here: the planner is imported when somebody asks for it."""

from phframe.registry import Extension, Kind, hookimpl


@hookimpl
def phframe_extensions() -> list[Extension]:
    """One planner."""
    return [
        Extension(
            Kind.PLANNER,
            "lookahead",
            "phframe_lookahead.lookahead:Lookahead",
            "Simulates the sweep of every group and object, and takes the one that leaves the fewest in the way",
            api_version=2,
        )
    ]
