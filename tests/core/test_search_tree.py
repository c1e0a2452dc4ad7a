"""Search trees: growing, going back, the chosen path, and what a file holds of a large one."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import TypeAdapter

from phframe.core import (
    ROOT,
    Action,
    Condition,
    Contacts,
    Decision,
    ExploredTree,
    GripperPath,
    InputError,
    Motion,
    Phase,
    PhaseRule,
    Plan,
    SearchNode,
    SearchTree,
    State,
    Status,
    Transition,
)

PATH = GripperPath(np.zeros((2, 3)), (Phase.INSERT,), {Phase.INSERT: PhaseRule(0.2, 0.0, Contacts.OBJECTS)})


def state(x: float) -> State:
    return State(np.array([[x, 0.3, 0.06, 1.0, 0.0, 0.0, 0.0]]), (Condition.UPRIGHT,))


def grown(parents: list[int]) -> SearchTree:
    """A tree whose n-th node after the root has the n-th parent, or the root where there is none yet."""
    tree = SearchTree(state(0.0))
    for number, parent in enumerate(parents, start=1):
        made = Transition(state(float(number)), Motion(1.0))
        closed = "stalled" if number % 2 else ""
        tree.child(parent % number, Action(f"a{number}", PATH), made, Decision(f"why {number}"), closed=closed)
    return tree


trees = st.lists(st.integers(0, 100), max_size=30).map(grown)


@given(trees, st.data())
def test_a_path_leads_from_the_root_and_each_action_from_the_state_before(
    tree: SearchTree, data: st.DataObject
) -> None:
    node = data.draw(st.integers(0, len(tree) - 1))
    path = tree.path(node)
    assert len(path) == tree.depth(node)
    row = ROOT
    for each in path:
        assert each.parent == row
        row = next(number for number in range(len(tree)) if tree[number] is each)
    assert row == node


@given(trees)
def test_the_deepest_node_is_as_deep_as_any(tree: SearchTree) -> None:
    assert tree.depth(tree.deepest) == max(tree.depth(node) for node in range(len(tree)))


@given(trees, st.data())
def test_a_plan_is_a_path_and_goes_through_json(tree: SearchTree, data: st.DataObject) -> None:
    node = data.draw(st.integers(0, len(tree) - 1))
    plan = tree.plan(node, Status.FAILED, "no")
    assert [action.name for action in plan.actions] == [each.action.name for each in tree.path(node) if each.action]
    assert plan.expected == tuple(each.state for each in tree.path(node))
    assert len(plan.decisions) == len(plan.actions)
    adapter = TypeAdapter(Plan)
    assert adapter.validate_json(adapter.dump_json(plan)) == plan


@settings(max_examples=50)
@given(trees, st.integers(1, 40), st.data())
def test_a_summary_keeps_the_chosen_path_and_counts_the_rest(tree: SearchTree, most: int, data: st.DataObject) -> None:
    node = data.draw(st.integers(0, len(tree) - 1))
    whole = tree.explored(node)
    short = whole.summarised(most)
    assert [each.state for each in short.path] == [each.state for each in whole.path]
    assert [each.action for each in short.path] == [each.action for each in whole.path]
    assert len(short.nodes) + sum(short.omitted.values()) == len(whole.nodes)
    assert len(short.nodes) <= max(most, len(whole.path) + 1)
    assert short.summarised(most) == short


@given(trees, st.data())
def test_the_part_after_some_actions_begins_there_and_goes_on_as_before(tree: SearchTree, data: st.DataObject) -> None:
    whole = tree.explored(data.draw(st.integers(0, len(tree) - 1)))
    done = data.draw(st.integers(0, len(whole.path)))
    part = whole.after(done)
    begin = (whole.nodes[ROOT], *whole.path)[done]
    root = part.nodes[ROOT]
    assert (root.state, root.parent, root.action, root.closed) == (begin.state, None, begin.action, begin.closed)
    assert [node.state for node in part.path] == [node.state for node in whole.path[done:]]
    assert [node.action for node in part.path] == [node.action for node in whole.path[done:]]
    assert not part.omitted


@given(trees, st.data())
def test_the_part_after_some_actions_holds_all_that_follows_and_nothing_else(
    tree: SearchTree, data: st.DataObject
) -> None:
    whole = tree.explored(data.draw(st.integers(0, len(tree) - 1)))
    done = data.draw(st.integers(0, len(whole.path)))
    begin = (whole.nodes[ROOT], *whole.path)[done]
    follow = [row for row in range(len(tree)) if begin in (whole.nodes[ROOT], *tree.path(row))]
    part = whole.after(done)
    assert len(part.nodes) == len(follow)
    for row, node in zip(follow[1:], part.nodes[1:], strict=True):
        assert (node.state, node.action, node.closed) == (tree[row].state, tree[row].action, tree[row].closed)
        assert part.nodes[node.parent or ROOT].state == tree[tree[row].parent or ROOT].state


@given(trees, st.data())
def test_parts_of_parts_are_parts(tree: SearchTree, data: st.DataObject) -> None:
    whole = tree.explored(data.draw(st.integers(0, len(tree) - 1)))
    first = data.draw(st.integers(0, len(whole.path)))
    second = data.draw(st.integers(0, len(whole.path) - first))
    assert whole.after(first).after(second) == whole.after(first + second)
    assert whole.after(0) == whole


def test_a_tree_of_a_hundred_thousand_nodes_is_a_small_file() -> None:
    root = SearchNode(state(0.0))
    more = SearchNode(state(0.1), ROOT, Action("a", PATH), Motion(1.0), Decision(), closed="stalled")
    tree = ExploredTree((root, *[more] * 100_000), 7).summarised()
    assert sum(tree.omitted.values()) > 99_000
    assert tree.omitted["stalled"] > 99_000
    assert len(TypeAdapter(ExploredTree).dump_json(tree)) < 2_000_000
    assert json.loads(TypeAdapter(ExploredTree).dump_json(tree))["chosen"] < len(tree.nodes)


@pytest.mark.parametrize(
    ("nodes", "chosen"),
    [
        ((), 0),
        ((SearchNode(state(0.0)),), 1),
        ((SearchNode(state(0.0), 0),), 0),
        ((SearchNode(state(0.0)), SearchNode(state(0.1), 1, Action("a", PATH), Motion(1.0), Decision())), 0),
        ((SearchNode(state(0.0)), SearchNode(state(0.1), -1, Action("a", PATH), Motion(1.0), Decision())), 0),
        ((SearchNode(state(0.0)), SearchNode(state(0.1), 0)), 0),
    ],
    ids=["empty", "no such chosen", "a root with a parent", "its own parent", "a negative parent", "no action"],
)
def test_what_is_no_tree_is_refused(nodes: tuple[SearchNode, ...], chosen: int) -> None:
    with pytest.raises(InputError, match="search tree"):
        ExploredTree(nodes, chosen)
