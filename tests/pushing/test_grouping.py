"""The closest component and its rectangle."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from phframe.pushing.grouping import bounding_rectangle, closest_component, merged_labels
from tests.pushing.parts import often

coordinate = st.integers(0, 6).map(lambda step: step / 8.0)  # exact in binary, so that ties are ties
labelled = st.lists(st.tuples(coordinate, coordinate, st.integers(0, 3)), min_size=1, max_size=10)


@often
@given(labelled, coordinate)
def test_the_component_holds_the_obstacle_nearest_to_the_gripper(
    objects: list[tuple[float, float, int]], axis: float
) -> None:
    array = np.array(objects)
    local, labels = array[:, :2], array[:, 2].astype(np.int64)
    chosen = closest_component(local, labels, axis)
    label = {int(labels[row]) for row in chosen}
    assert len(label) == 1
    assert chosen.tolist() == [row for row in range(len(objects)) if int(labels[row]) in label]
    key = min((x, abs(y - axis)) for x, y, _ in objects)
    assert key in {(x, abs(y - axis)) for x, y, each in objects if each in label}


def test_of_obstacles_equally_near_the_one_nearest_to_the_centre_line_counts() -> None:
    local = np.array([[0.5, 0.25], [0.25, 0.5], [0.25, 0.375], [0.75, 0.25]])
    assert closest_component(local, np.array([0, 1, 2, 2]), 0.25).tolist() == [2, 3]
    assert closest_component(local, np.array([0, 1, 2, 2]), 0.625).tolist() == [1]


@often
@given(st.lists(st.tuples(st.floats(-1, 1), st.floats(-1, 1)), min_size=1, max_size=8))
def test_the_rectangle_is_the_smallest_that_holds_all(points: list[tuple[float, float]]) -> None:
    rectangle = bounding_rectangle(np.array(points))
    for axis in (0, 1):
        values = [point[axis] for point in points]
        assert (rectangle.lower[axis], rectangle.upper[axis]) == (min(values), max(values))


@given(st.lists(st.integers(0, 4), min_size=1, max_size=10))
def test_with_one_point_each_the_labels_are_those_of_the_points(drawn: list[int]) -> None:
    order = {label: number for number, label in enumerate(dict.fromkeys(drawn))}
    labels = np.array([order[label] for label in drawn])
    assert merged_labels(labels, np.arange(len(labels))).tolist() == labels.tolist()


def test_an_object_with_points_in_two_components_makes_them_one() -> None:
    labels, owners = np.array([0, 1, 1, 2, 3, 0]), np.array([0, 1, 2, 2, 3, 4])
    assert merged_labels(labels, owners).tolist() == [0, 1, 1, 2, 0]
    assert merged_labels(np.array([0, 1, 2, 1]), np.array([0, 0, 1, 1])).tolist() == [0, 0]
