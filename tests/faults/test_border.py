"""What parts return is checked where it comes in: the error names the part and what was wrong, and nothing is kept of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from phframe.arms.planar import PlanarArm
from phframe.backends.pymunk_.physics import PymunkPhysics
from phframe.core import (
    Assessment,
    Attempt,
    Episode,
    FloatArray,
    IntArray,
    Loop,
    Motion,
    PersistenceDiagram,
    PhframeError,
    Plan,
    PluginError,
    RunSpec,
    Scene,
    Settle,
    State,
    Status,
    Stop,
    Task,
    Trajectory,
    Watch,
)
from phframe.core.motion import Contact
from phframe.planners.phia import PHIA
from phframe.pushing.retrieve import Retrieve
from phframe.runtime.observer import Observer
from phframe.runtime.run import run
from phframe.topology.single_linkage import SingleLinkage
from tests.trials import TIMES, tried

SCENE = "vieira/simple-07"
SCENES = [
    SCENE,
    *(f"vieira/simple-0{number}" for number in (1, 2, 3, 4, 6, 8)),
    "papallas/s01",
    "papallas/s02",
    "papallas/s03",
][:TIMES]
Change = Callable[[Any], Any]


def forced(value: Any, **fields: Any) -> Any:
    """A frozen value with fields that its constructor would not take."""
    for name, field in fields.items():
        object.__setattr__(value, name, field)
    return value


def last_node(plan: Plan, **fields: Any) -> Plan:
    assert plan.tree is not None
    *nodes, last = plan.tree.nodes
    return replace(plan, tree=replace(plan.tree, nodes=(*nodes, forced(replace(last), **fields))))


def poses(value: Any) -> Any:
    return lambda state: forced(state, poses=value)


def one_pose(figure: float) -> Change:
    def change(state: State) -> State:
        changed = state.poses.copy()
        changed[0, 0] = figure
        return replace(state, poses=changed)

    return change


PLANS: dict[str, Change] = {
    "none": lambda plan: None,
    "a number": lambda plan: 3,
    "no status": lambda plan: replace(plan, status="great"),
    "no tree": lambda plan: replace(plan, tree=[]),
    "no reason": lambda plan: replace(plan, reason=3),
    "a reason that cannot be written": lambda plan: replace(plan, reason="\ud800"),
    "no nodes": lambda plan: replace(plan, tree=forced(replace(plan.tree), nodes=())),
    "a path that goes nowhere": lambda plan: replace(plan, tree=forced(replace(plan.tree), chosen=10**6)),
    "no state": lambda plan: last_node(plan, state=None),
    "a state of another scene": lambda plan: last_node(plan, state=State(np.zeros((0, 7)), ())),
    "a pose that is no number": lambda plan: last_node(plan, state=one_pose(np.nan)(plan.expected[-1])),
    "an infinite pose": lambda plan: last_node(plan, state=one_pose(np.inf)(plan.expected[-1])),
    "something held that is not there": lambda plan: last_node(plan, state=replace(plan.expected[-1], held="x")),
    "no action": lambda plan: last_node(plan, action=None),
    "an action that is a text": lambda plan: last_node(plan, action="push"),
    "objects that are not there": lambda plan: last_node(plan, action=replace(plan.actions[-1], moves=("x",))),
    "a path that is no number": lambda plan: last_node(
        plan, action=forced(replace(plan.actions[-1]), path=forced(replace(plan.actions[-1].path), poses=np.nan))
    ),
    "a parent after its child": lambda plan: last_node(plan, parent=10**6),
    "a negative duration": lambda plan: last_node(plan, motion=Motion(-1.0)),
    "a duration that is no number": lambda plan: last_node(plan, motion=Motion(np.nan)),
    "a value that is no number": lambda plan: last_node(plan, value=float("nan")),
    "no decision": lambda plan: last_node(plan, decision=None),
}
STATES: dict[str, Change] = {
    "none": lambda state: None,
    "a list": lambda state: [state],
    "no poses": poses(None),
    "flat poses": poses(np.zeros(7)),
    "whole poses": poses(np.zeros((1, 7), dtype=int)),
    "a pose that is no number": one_pose(np.nan),
    "an infinite pose": one_pose(np.inf),
    "one object too few": lambda state: State(state.poses[1:], state.conditions[1:], None, state.arm),
    "no conditions": lambda state: forced(state, conditions=None),
    "other conditions": lambda state: forced(state, conditions=("fine",) * len(state.conditions)),
    "something held that is not there": lambda state: forced(state, held="x"),
    "a number held": lambda state: forced(state, held=3),
    "no arm": lambda state: forced(state, arm="arm"),
}
MOTIONS: dict[str, Change] = {
    "none": lambda motion: None,
    "a number": lambda motion: 1.0,
    "a negative duration": lambda motion: replace(motion, duration=-1.0),
    "a duration that is no number": lambda motion: replace(motion, duration=float("nan")),
    "a duration in words": lambda motion: replace(motion, duration="long"),
    "an infinite force": lambda motion: replace(motion, largest_force=float("inf")),
    "a negative error": lambda motion: replace(motion, tracking_error=-1.0),
    "stalled by half": lambda motion: replace(motion, stalled=0.5),
    "stopped by a text": lambda motion: replace(motion, stopped="wall"),
    "contacts with nobody": lambda motion: replace(motion, contacts=(None,)),
    "contacts that are none": lambda motion: replace(motion, contacts=None),
    "contacts at no time": lambda motion: replace(motion, contacts=(Contact(float("nan"), "o", "reach"),)),  # type: ignore[arg-type]
    "contacts in no phase": lambda motion: replace(motion, contacts=(Contact(0.0, "o", "x"),)),  # type: ignore[arg-type]
}
DIAGRAMS: dict[str, Change] = {
    "none": lambda found: None,
    "births alone": lambda found: PersistenceDiagram(found.births, found.deaths[1:]),
    "too many bars": lambda found: PersistenceDiagram(np.zeros(99), np.full(99, np.inf)),
    "no numbers": lambda found: PersistenceDiagram(found.births, found.deaths * np.nan),
    "a death before birth": lambda found: PersistenceDiagram(found.births + 1.0, found.deaths),
    "a negative birth": lambda found: PersistenceDiagram(found.births - 1.0, found.deaths),
    "nobody lives": lambda found: PersistenceDiagram(found.births, np.minimum(found.deaths, 1.0)),
    "deaths in disorder": lambda found: PersistenceDiagram(found.births[:3], np.array([0.2, 0.1, np.inf])),
}
LABELS: dict[str, Change] = {
    "none": lambda found: None,
    "one too few": lambda found: found[1:],
    "fractions": lambda found: found + 0.5,
    "from one": lambda found: found + 1,
    "negative": lambda found: -found - 1,
    "texts": lambda found: [str(label) for label in found],
}
ASSESSMENTS: dict[str, Change] = {
    "none": lambda found: None,
    "a text": lambda found: "retrieved",
    "no status": lambda found: replace(found, status="won"),
    "no reason": lambda found: replace(found, reason=None),
}


def planner_of(change: Change) -> Any:
    class Wrong(PHIA):
        def search(self, task: Task) -> Plan:
            return change(super().search(task))  # type: ignore[no-any-return]

    return Wrong


def backend_of(of_state: Change = lambda state: state, of_motion: Change = lambda motion: motion) -> Any:
    class Wrong(PymunkPhysics):
        def execute(
            self, trajectory: Trajectory, *, settle: Settle | None, stop: Stop | None = None, watch: Watch | None = None
        ) -> Motion:
            return of_motion(super().execute(trajectory, settle=settle, stop=stop, watch=watch))  # type: ignore[no-any-return]

        def observe(self) -> State:
            return of_state(super().observe())  # type: ignore[no-any-return]

    return Wrong


def topology_of(of_diagram: Change = lambda found: found, of_labels: Change = lambda found: found) -> Any:
    class Wrong(SingleLinkage):
        def diagram(self, points: FloatArray) -> PersistenceDiagram:
            return of_diagram(super().diagram(points))  # type: ignore[no-any-return]

        def components(self, points: FloatArray, radius: float) -> IntArray:
            return of_labels(super().components(points, radius))  # type: ignore[no-any-return]

    return Wrong


def goal_of(change: Change) -> Any:
    class Wrong(Retrieve):
        def assess(self, scene: Scene, state: State, last: Attempt | None = None) -> Assessment:
            return change(super().assess(scene, state, last))  # type: ignore[no-any-return]

    return Wrong


KINDS = [
    *[pytest.param({"planner": planner_of(change)}, id=f"plan: {name}") for name, change in PLANS.items()],
    *[pytest.param({"backend": backend_of(change)}, id=f"state: {name}") for name, change in STATES.items()],
    *[
        pytest.param({"backend": backend_of(of_motion=change)}, id=f"motion: {name}")
        for name, change in MOTIONS.items()
    ],
    *[pytest.param({"topology": topology_of(change)}, id=f"diagram: {name}") for name, change in DIAGRAMS.items()],
    *[
        pytest.param({"topology": topology_of(of_labels=change)}, id=f"labels: {name}")
        for name, change in LABELS.items()
    ],
    *[pytest.param({"goal": goal_of(change)}, id=f"goal: {name}") for name, change in ASSESSMENTS.items()],
]


class Kept(Observer):
    """Keeps what there was of an episode that ended early."""

    episode: Episode | None = None

    def interrupted(self, episode: Episode) -> None:
        self.episode = episode


@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("wrong", KINDS)
def test_what_a_part_returns_that_cannot_be_is_told_as_its_own(wrong: dict[str, Any], scene: str) -> None:
    tried("inputs: what parts return")
    kept, [(kind, part)] = Kept(), wrong.items()
    with pytest.raises(PhframeError) as caught:
        run(RunSpec(scene, **wrong, loop=Loop(time_limit=20.0, max_replans=1)), [kept])
    assert isinstance(caught.value, PluginError)
    assert f"{kind} {part.__name__}" in str(caught.value).replace("'", "") or "planner Wrong returned" in str(
        caught.value
    )
    assert len(str(caught.value)) < 1000
    assert "\n" not in str(caught.value)
    assert kept.episode is not None
    assert kept.episode.status is Status.FAILED
    assert kept.episode.reason == str(caught.value)


@pytest.mark.parametrize("figures", [{"link_width": np.nan}, {"max_opening": -1.0}, {"closed": None}])
def test_an_arm_that_cannot_be_is_refused_by_name(figures: dict[str, Any]) -> None:
    class Wrong(PlanarArm):
        @property
        def shape(self) -> Any:
            return replace(super().shape, **figures)

    with pytest.raises(PluginError, match="arm 'Wrong'"):
        run(RunSpec(SCENE, arm=Wrong))


def test_parts_that_keep_to_their_interfaces_change_no_bit_by_being_watched() -> None:
    def same(found: Any) -> Any:
        return found

    expected = run(RunSpec(SCENE))
    for parts in ({"planner": planner_of(same)}, {"backend": backend_of()}, {"topology": topology_of()}):
        found = run(RunSpec(SCENE, **{"topology": "ripser", **parts}))
        assert [step.after for step in found.steps] == [step.after for step in expected.steps]
        assert (found.status, found.plans[0].status) == (expected.status, expected.plans[0].status)
