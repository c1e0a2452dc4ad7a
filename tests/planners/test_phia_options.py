"""What PHIA's options choose, in the plans for published scenes."""

from __future__ import annotations

import pytest

from phframe.core import ActionKind, Status
from phframe.pushing import Deviation, PushDecision
from phframe.runtime.scenes import find_scene
from phframe.runtime.solve import solve
from tests.planners.solved import PLANNERS
from tests.planners.test_plans import planned


@pytest.mark.parametrize(("radius", "expected"), [("smallest", 0.0857), ("largest", 0.1213)])
def test_the_radius_is_the_smallest_or_the_largest_usable_one(radius: str, expected: float) -> None:
    first = PushDecision.of(planned(find_scene("vieira/basic"), radius=radius).decisions[0])
    assert first.radius == pytest.approx(expected, abs=1e-4)


@pytest.mark.parametrize("planner", PLANNERS)
def test_the_papers_sweeps_are_never_tilted_shifted_or_the_other_way(planner: str) -> None:
    kept = {Deviation.FALLBACK_RADIUS, Deviation.LANE_CLAMPED, Deviation.SWEEP_CLAMPED, Deviation.GRASP_BLOCKED}
    pushes = 0
    for scene in ("vieira/basic", "vieira/example-03", "papallas/s02"):
        plan = planned(find_scene(scene), planner, sweeps="paper")
        assert plan.tree is not None
        for node in plan.tree.nodes[1:]:
            if node.action is not None and node.action.kind is ActionKind.PUSH:
                assert set(PushDecision.of(node.decision).deviations) <= kept
                pushes += 1
        assert plan.cost.simulated_actions == len(plan.actions) or plan.status is Status.FAILED
    assert pushes >= 3


def test_grasping_first_takes_fewer_pushes() -> None:
    scenes = [f"vieira/example-{number:02d}" for number in (1, 2, 3, 4)]
    chosen: list[dict[str, object]] = [{}, {"grasp_first": True}, {"grasp_first": True, "radius": "largest"}]
    runs = [[solve(scene, planner="phia", options={"planner": each}) for scene in scenes] for each in chosen]
    assert all(episode.status is Status.RETRIEVED for run in runs for episode in run)
    usual, early, largest = (sum(episode.pushes for episode in run) for run in runs)
    assert usual > early >= largest
    assert any(Deviation.GRASP_EARLY in episode.deviations for episode in runs[1])
