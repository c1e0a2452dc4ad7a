from __future__ import annotations

import itertools
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("rerun")

import rerun.blueprint as rrb

from phframe.core import (
    ROOT,
    Condition,
    Decision,
    FloatArray,
    SearchTree,
    Shape,
    State,
    Transition,
    UnknownShapeError,
)
from phframe.recorders import palette
from phframe.recorders.decision_entities import log_decision
from phframe.recorders.object_solids import disc_radius, primitive_of
from phframe.recorders.rerun_ import RerunRecorder
from phframe.recorders.stream import Stream
from phframe.recorders.tree_entities import MOST_SHOWN, layout, omitted_label
from tests.prism import PRISM
from tests.recorders.reading import Recording
from tests.recorders.recorded import record
from tests.recorders.synthetic_episode import SCENE, SPEC, Recorded, failed_plan, mounted

pytestmark = pytest.mark.needs_rerun


@pytest.fixture(scope="module")
def recording(made: Recorded, tmp_path_factory: pytest.TempPathFactory) -> Recording:
    path = tmp_path_factory.mktemp("recording") / "episode.rrd"
    record(made, path)
    assert path.stat().st_size < 1_000_000
    return Recording(path)


def packed(color: palette.Color) -> int:
    return int.from_bytes(bytes(color))


def test_two_timelines_and_no_other(recording: Recording) -> None:
    assert recording.timelines == {"sim_time", "action"}


def test_everything_there_is_to_see_has_an_entity(recording: Recording) -> None:
    expected = {
        *(f"/world/objects/{i}" for i in SCENE.ids),
        *(f"/world/shelf/{part}" for part in ("board", "walls", "edges")),
        "/top/arm",
        *(f"/world/arm/{part}{piece}" for part in ("link", "palm", "left\\ finger") for piece in ("", "/0")),
        "/top/arm/palm/edge",
        "/top/objects",
        "/top/marks",
        "/top/shelf/sides",
        *(f"/world/decision/{part}" for part in ("corridor", "links", "rectangle", "sweep", "path")),
        *(f"/top/decision/{part}" for part in ("corridor/area", "links", "rectangle", "sweep", "path", "expected")),
        *(f"/persistence/{part}" for part in ("bars", "persistent", "radius", "scale")),
        *(f"/numbers/{name}" for name in ("corridor/obstacles", "force/largest", "displacement/target")),
        *(f"/numbers/{name}" for name in ("planning/total", "radius/chosen", "radius/persistent")),
        "/story/log",
        "/story/decision",
    }
    assert expected <= recording.entities


def test_layout_is_explicit(recording: Recording) -> None:
    assert recording.blueprints == 1
    assert {"Shelf", "From the top", "Persistence", "Decision", "What happened and why"} <= recording.views
    assert {"Obstacles in the corridor", "Contact force (N)", "Planning time (ms)"} <= recording.views


def test_every_moving_object_is_where_the_frames_say(recording: Recording, made: Recorded) -> None:
    rows = recording.rows("/world/objects/object_1", "translation")
    first = {round(time, 6): state.poses[0, :3] for time, state in made.frames[0]}
    compared = [
        (place[0], first[round(time, 6)]) for time, action, place in rows if action == 1 and round(time, 6) in first
    ]
    assert len(compared) > 40
    assert all(np.allclose(written, really, atol=1e-6) for written, really in compared)


def test_what_tilts_is_tilted(made: Recorded, tmp_path: Path) -> None:
    step, row = made.episode.steps[1], SCENE.index("object_3")
    poses = step.after.poses.copy()
    poses[row, 2:] = [0.03, np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0]
    recorder = RerunRecorder(tmp_path / "tilted.rrd")
    recorder.begin(SCENE, SPEC, made.arm)
    recorder.stepped(replace(step, after=replace(step.after, poses=poses)), made.frames[1])
    recorder.close()
    turned = Recording(recorder.path).rows("/world/objects/object_3", "quaternion")[-1][2][0]
    np.testing.assert_allclose(turned, [np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)], atol=1e-6)


def test_what_stands_still_is_not_written_again_and_again(recording: Recording) -> None:
    assert len(recording.rows("/world/objects/object_4", "translation")) == 4


def test_actions_follow_each_other_in_time(recording: Recording, made: Recorded) -> None:
    rows = recording.rows("/world/arm/link", "translation")
    durations = [step.motion.duration for step in made.episode.steps]
    assert [action for _, action, _ in rows] == sorted(action for _, action, _ in rows)
    assert rows[-1][1] == 3
    ends = [time for time, _, _ in recording.rows("/numbers/force/largest", "scalars")]
    np.testing.assert_allclose(ends, [0.0, *np.cumsum(durations)], atol=1e-6)
    for number, (begins, over) in enumerate(itertools.pairwise(ends), 1):
        assert all(begins <= time <= over for time, action, _ in rows if action == number)


def test_arm_ends_where_the_state_after_says(recording: Recording, made: Recorded) -> None:
    arm = made.episode.final_state.arm
    assert arm is not None
    x, y, height = *arm.gripper[:2], made.arm.shape.height
    places = {
        "/top/arm": (x, y, 0.0),
        "/top/arm/left\\ finger": (0.0, arm.opening / 2.0, 0.0),
        "/world/arm/link": (x, y, height),
        "/world/arm/left\\ finger": (x, y + arm.opening / 2.0, height),
        "/world/arm/right\\ finger": (x, y - arm.opening / 2.0, height),
    }
    for entity, place in places.items():
        np.testing.assert_allclose(recording.rows(entity, "translation")[-1][2][0], place, atol=1e-6)


def test_members_take_the_colour_of_their_component(recording: Recording) -> None:
    colors = {i: recording.rows(f"/world/objects/{i}", "colors") for i in SCENE.ids}
    during = {i: next(value[0] for _, action, value in rows if action == 1) for i, rows in colors.items()}
    first, second = palette.component_color(0), palette.component_color(1)
    assert during["object_1"] == during["object_2"] == packed(first)
    assert during["object_3"] == packed(second)
    assert during["object_4"] == packed(palette.OBJECT)
    assert during["mug"] == packed(palette.TARGET)
    assert not any(recording.is_constant(f"/world/objects/{i}", "colors") for i in SCENE.ids)


def test_what_topples_turns_red_when_it_does(recording: Recording, made: Recorded) -> None:
    rows = [
        (time, value[0]) for time, action, value in recording.rows("/world/objects/object_3", "colors") if action == 2
    ]
    red = [time for time, color in rows if color == packed(palette.TOPPLED)]
    began = made.episode.steps[0].motion.duration
    falls = next(time for time, state in made.frames[1] if Condition.TOPPLED in state.conditions)
    assert red
    assert min(red) == pytest.approx(began + falls, abs=1e-6)
    last = recording.rows("/world/objects/object_3", "colors")[-1]
    assert last[2][0] == packed(palette.TOPPLED), "and stays so"


def test_bars_of_a_decision_and_none_without(recording: Recording) -> None:
    bars = {action: value for _, action, value in recording.rows("/persistence/bars", "strips")}
    assert [len(bars[action]) for action in (1, 2, 3)] == [3, 1, 0]
    captions = {action: value for _, action, value in recording.rows("/persistence/persistent", "labels")}
    assert captions[1] == ["76", "152"]
    chosen = {action: value for _, action, value in recording.rows("/persistence/radius/value", "labels")}
    assert chosen[1] == ["chosen radius 76 mm"]
    assert not chosen[3]


def test_links_join_members_within_the_radius_only(recording: Recording, made: Recorded) -> None:
    links = {action: value for _, action, value in recording.rows("/top/decision/links", "strips")}
    before = made.episode.steps[0].before.positions
    assert len(links[1]) == 1
    np.testing.assert_allclose(links[1][0], before[[0, 1]], atol=1e-6)
    assert not links[2]
    assert not links[3]


def test_grasp_wipes_the_rectangle_off(recording: Recording) -> None:
    for view in ("top", "world"):
        rectangles = {action: value for _, action, value in recording.rows(f"/{view}/decision/rectangle", "strips")}
        assert [len(rectangles[action]) for action in (1, 2, 3)] == [1, 1, 0]


def test_expected_places_are_marked_for_what_is_to_move(recording: Recording) -> None:
    marked = {action: value for _, action, value in recording.rows("/top/decision/expected", "centers")}
    np.testing.assert_allclose(marked[3], [[-0.10, 0.30]], atol=1e-6)


def test_numbers_over_time(recording: Recording) -> None:
    counts = [value[0] for _, _, value in recording.rows("/numbers/corridor/obstacles", "scalars")]
    assert (counts[0], min(counts), counts[-1]) == (3.0, 0.0, 0.0)
    assert [value[0] for _, _, value in recording.rows("/numbers/force/largest", "scalars")] == [0.0, 12.5, 12.5, 3.0]
    assert [value[0] for _, _, value in recording.rows("/numbers/planning/total", "scalars")] == [30.0, 10.0]
    radii = [value[0] for _, _, value in recording.rows("/numbers/radius/persistent", "scalars")]
    np.testing.assert_allclose(radii, [76.2, 152.3])


def test_target_displacement_ends_when_it_is_held(recording: Recording) -> None:
    moved = [value[0] for _, _, value in recording.rows("/numbers/displacement/target", "scalars")]
    assert max(moved) < 1.0, "it was carried 520 mm"


def test_story_says_what_was_decided_and_warns(recording: Recording) -> None:
    told = [(value[0], action) for _, action, value in recording.rows("/story/log", "text")]
    assert told[0] == ("hand/made: retrieve mug among 4 other objects (phia, pymunk, arm planar, ripser, seed 7)", 0)
    assert ("plan 2 (replanned): 2 actions, expected to end retrieved (10 ms, 0 simulated actions)", 1) in told
    assert any("radii 76, 152 mm; chosen 76 mm, 2 components" in line for line, _ in told)
    assert {value[0] for _, _, value in recording.rows("/story/log", "level")} == {"INFO"}
    assert recording.rows("/story/log", "color") == [], "the viewer's theme says in which"
    assert [value[0] for _, _, value in recording.rows("/story/log/warnings", "text")] == [
        "2. done in 3.0 s, largest force 12 N, object_3 toppled",
        "3. done in 4.0 s, largest force 3 N, touched the north wall",
    ]


def test_setup_is_kept_with_the_recording(recording: Recording) -> None:
    assert recording.constant("/__properties/setup", "planner") == ["phia"]
    assert recording.constant("/__properties/setup", "planner_margin") == ["0.015"]


def test_names_in_discs_are_short(recording: Recording) -> None:
    assert recording.constant("/top/names", "labels") == ["1", "2", "3", "4", "target"]


def test_decision_without_anything_and_no_frames(made: Recorded, tmp_path: Path) -> None:
    step = made.episode.steps[0]
    bare = replace(step, decision=Decision("on a whim"))
    recorder = RerunRecorder(tmp_path / "bare.rrd")
    recorder.begin(SCENE, SPEC, made.arm)
    recorder.stepped(bare, ())
    recorder.close()
    rows = partial(Recording(recorder.path).rows)
    assert rows("/top/decision/corridor/area", "strips")[-1][2] == []
    assert rows("/world/objects/object_1", "translation")[-1][0] == pytest.approx(step.motion.duration)


def test_links_move_joint_by_joint_where_the_states_have_joints(made: Recorded, tmp_path: Path) -> None:
    arm = mounted(by_joints=True)

    def with_joints(state: State) -> State:
        assert state.arm is not None
        x, y, yaw = state.arm.gripper
        return replace(state, arm=replace(state.arm, joints=np.array([x - arm.base_pose.x, y - arm.base_pose.y, yaw])))

    recorder, step = RerunRecorder(tmp_path / "joints.rrd"), made.episode.steps[0]
    recorder.begin(SCENE, SPEC, arm)
    recorder.stepped(replace(step, after=with_joints(step.after)), [(t, with_joints(s)) for t, s in made.frames[0]])
    recorder.close()
    recording = Recording(recorder.path)
    assert {"/world/arm/fingertip/0", "/world/arm/left_finger_link/0", "/top/arm/palm/edge"} <= recording.entities
    assert "/world/arm/palm" not in recording.entities
    rows = recording.rows("/world/arm/fingertip", "translation")
    written = {round(time, 6): place[0] for time, _, place in rows}
    np.testing.assert_allclose(rows[0][2][0], arm.base_pose.pose[:3], atol=1e-6, err_msg="parked at home")
    compared = [(time, state.arm) for time, state in made.frames[0] if round(time, 6) in written and time > 0.0]
    assert len(compared) > 20
    for time, arm_state in compared:
        assert arm_state is not None
        np.testing.assert_allclose(written[round(time, 6)], [*arm_state.gripper[:2], 0.06], atol=1e-6)


def test_a_plan_that_failed_shows_its_tree_and_where_it_got_farthest(made: Recorded, tmp_path: Path) -> None:
    recorder, plan = RerunRecorder(tmp_path / "failed.rrd"), failed_plan()
    recorder.begin(SCENE, SPEC, made.arm)
    recorder.planned(plan)
    recorder.finished(replace(made.episode, status=plan.status, reason=plan.reason, plans=(plan,), steps=()))
    recorder.close()
    recording = Recording(recorder.path)
    north, south = "sweep north: object_1,", "sweep south: object_3"
    (labels,) = [value for _, _, value in recording.rows("/search/tree", "labels")]
    assert [text.split("\n")[0] for text in labels] == ["start", north, south, south, north]
    assert "value -1" in labels[1]
    assert labels[2].endswith("something spilled")
    (colors,) = [value for _, _, value in recording.rows("/search/tree", "colors")]
    chosen, closed = packed(palette.GREEN_INK), packed(palette.RED_INK)
    assert colors == [chosen, chosen, closed, chosen, closed]
    (edges,) = [value for _, _, value in recording.rows("/search/tree", "edges")]
    assert [tuple(edge.values()) for edge in edges] == [("0", "1"), ("0", "2"), ("1", "3"), ("3", "4")]
    log = [value[0] for _, _, value in recording.rows("/story/log/warnings", "text")]
    assert any("3. only simulated" in line and "given up: nothing moved" in line for line in log)
    for item, pose in zip(SCENE.objects, plan.expected[-1].poses, strict=True):
        *_, (_, action, last) = recording.rows(f"/world/objects/{item.id}", "translation")
        np.testing.assert_allclose(last[0], pose[:3], atol=1e-6)
        assert action > 0 or item.id in ("object_4", "mug")
    assert {action for _, action, _ in recording.rows("/top/decision/path", "strips")} == {1, 2, 3}


def test_of_a_large_tree_a_part_is_drawn_and_the_rest_counted(made: Recorded) -> None:
    step, tree = made.episode.steps[0], SearchTree(SCENE.initial_state())
    for _ in range(300):
        tree.child(ROOT, step.action, Transition(step.after, step.motion), closed="nothing moved")
    shown = tree.explored(7).summarised(MOST_SHOWN)
    assert omitted_label(shown).replace("\n", " ") == f"{301 - MOST_SHOWN} more: {301 - MOST_SHOWN} nothing moved"
    at = layout(shown.nodes)
    assert len(np.unique(at, axis=0)) == MOST_SHOWN, "no node hides another"


class Pyramid(Shape):
    kind, height = "pyramid", 0.1
    bounding_radius = area = 0.04
    outline = np.zeros((4, 2))

    def support(self, direction: FloatArray) -> float:
        return 0.04

    def inertia(self, mass: float) -> FloatArray:
        return np.ones(3)

    def figures(self) -> dict[str, float]:
        return {"height": self.height}


def test_a_shape_that_is_not_known_is_an_error() -> None:
    for draw in (primitive_of, disc_radius):
        with pytest.raises(UnknownShapeError, match="the recording has no primitive for the shape 'pyramid'"):
            draw(Pyramid())


def test_where_a_shape_that_is_not_known_is_to_go_is_an_error(made: Recorded, tmp_path: Path) -> None:
    step = made.episode.steps[2]
    scene = replace(SCENE, objects=tuple(replace(item, shape=PRISM) for item in SCENE.objects))
    with pytest.raises(UnknownShapeError, match="the recording has no primitive for the shape 'prism'"):
        log_decision(Stream(tmp_path / "a.rrd", "a", rrb.Blueprint(), {"seed": "7"}), scene, step)
