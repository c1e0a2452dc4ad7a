"""A repetition is compared bit by bit, and what differs first is named."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import phframe
from phframe.core import Episode, Motion, State, Status, StoredName
from phframe.runtime.replay import Difference, differing_versions, first_difference, spec_of

EPISODE = phframe.solve("vieira/basic", options={"planner": {"margin": 0.02}})


def with_step(row: int, **changes: object) -> Episode:
    steps = list(EPISODE.steps)
    steps[row] = replace(steps[row], **changes)  # type: ignore[arg-type]
    return replace(EPISODE, steps=tuple(steps))


def shifted(state: State, row: int, distance: float) -> State:
    poses = np.array(state.poses)
    poses[row, 0] += distance
    return replace(state, poses=poses)


def test_the_same_again_is_the_same(tmp_path: Path) -> None:
    back = phframe.load(phframe.save(EPISODE, tmp_path / "episode.json"))
    assert isinstance(back, Episode)
    assert first_difference(back, phframe.run(spec_of(back))) is None
    assert differing_versions(back) == {}


def test_the_first_difference_is_told_with_step_object_and_distance() -> None:
    row = EPISODE.scene.index("object_3")
    moved = with_step(1, after=shifted(EPISODE.steps[1].after, row, 0.0125))
    found = first_difference(EPISODE, moved)
    assert found is not None
    assert (found.step, found.object) == (2, "object_3")
    assert found.distance == pytest.approx(0.0125)
    assert str(found) == "step 2: object_3 is elsewhere by 0.0125 m"


def test_one_bit_is_a_difference() -> None:
    after = EPISODE.steps[0].after
    poses = np.array(after.poses)
    poses[0, 0] = np.nextafter(poses[0, 0], 1.0)
    assert first_difference(EPISODE, with_step(0, after=replace(after, poses=poses))) is not None
    assert first_difference(EPISODE, with_step(0, motion=replace(EPISODE.steps[0].motion, duration=9.0))) == Difference(
        "contacts, forces or times are not the same", 1
    )


def test_everything_that_is_not_the_same_is_found() -> None:
    others = [
        with_step(0, action=replace(EPISODE.steps[0].action, name="another")),
        with_step(0, trajectory=EPISODE.steps[1].trajectory),
        with_step(0, motion=Motion(1.0)),
        replace(EPISODE, steps=EPISODE.steps[:-1]),
        replace(EPISODE, status=Status.REACHED),
        replace(EPISODE, reason="why"),
        replace(EPISODE, plans=(*EPISODE.plans, EPISODE.plans[0])),
    ]
    assert all(first_difference(EPISODE, other) is not None for other in others)


def test_versions_and_wall_times_are_no_difference_and_versions_are_told() -> None:
    other = replace(EPISODE, versions={**EPISODE.versions, "numpy": "0.9"}, motion_planning_time=3.0)
    assert first_difference(EPISODE, other) is None
    assert differing_versions(other) == {"numpy": ("0.9", EPISODE.versions["numpy"])}


def test_another_part_comes_with_its_own_options_and_the_others_stay() -> None:
    spec = spec_of(EPISODE, planner="ooa", backend=None)
    assert (spec.planner, spec.backend, dict(spec.options)) == ("ooa", "pymunk", {})
    assert spec_of(EPISODE, planner="phia").options == {"planner": {"margin": 0.02}}
    assert spec_of(EPISODE, arm="baxter").plan_arm is None


def test_what_was_planned_with_the_same_part_follows_it() -> None:
    options = {"arm": {"link_width": 0.1}, "plan_arm": {"link_width": 0.12}}
    episode = replace(EPISODE, spec=replace(EPISODE.spec, options=options))
    same, other = (spec_of(episode, arm=arm, backend=episode.spec.backend) for arm in ("planar", "baxter"))
    assert (same.plan_arm, same.plan_backend, same.options) == ("planar", "pymunk", options)
    assert (other.plan_arm, other.plan_backend, other.options) == (None, "pymunk", {})
    assert spec_of(EPISODE, backend="mujoco").plan_backend is None
    assert spec_of(EPISODE, arm="baxter", plan_arm="planar").plan_arm == "planar"


def test_a_stored_class_in_a_file_is_replaced_by_the_given_one_wherever_it_was_used() -> None:
    stored = StoredName("./mine.py:Mine")
    before = replace(EPISODE.spec, arm=stored, plan_arm=stored, backend=stored, plan_backend=stored)
    spec = spec_of(replace(EPISODE, spec=before), arm=str(stored), backend=str(stored))
    assert {type(name) for name in (spec.arm, spec.plan_arm, spec.backend, spec.plan_backend)} == {str}
