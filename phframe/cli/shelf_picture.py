"""A shelf from above in letters: for terminals of any kind, over ssh too."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import groupby, takewhile
from operator import itemgetter
from typing import TYPE_CHECKING

import numpy as np

from phframe.core import FloatArray, Question, Scene

if TYPE_CHECKING:
    from rich.text import Text

LONGEST_LABEL = 6
"""Letters of an object's label; where its id is longer, and cannot be cut to what differs, it has a number."""
FREE, CORRIDOR, OBSTACLE, BLOCKER, TARGET = " ", ".", "o", "x", "*"
STYLES = {CORRIDOR: "blue", OBSTACLE: "", BLOCKER: "bold red", TARGET: "bold green"}
HEIGHT_OF_LETTER = 2.0
"""Times its width."""


def labels(scene: Scene) -> Mapping[str, str]:
    """A short label for each object, by its id: what obstacles' ids do not have in common, or its number in the scene."""
    obstacles = [name for name in scene.ids if name != scene.target]
    common = _common_beginning(obstacles)
    own = [name.removeprefix(common) for name in scene.ids]
    fits = len(set(own)) == len(own) and all(0 < len(label) <= LONGEST_LABEL for label in own)
    return dict(zip(scene.ids, own if fits else map(str, range(len(own))), strict=True))


def _common_beginning(names: Sequence[str]) -> str:
    same = takewhile(lambda letters: len(set(letters)) == 1, zip(*names, strict=False))
    return "".join(letters[0] for letters in same) if len(names) > 1 else ""


def shelf_picture(question: Question, columns: int, rows: int) -> Text:
    """The shelf as one sees it from the mouth, which is below: depth x upwards, y to the left.

    Args:
        question: Scene, state, corridor and blocker.
        columns: Letters in a line, at most.
        rows: Lines, at most; two are taken by the back wall and the scale.
    """
    from rich.text import Text

    shelf = question.scene.shelf
    cell = max(shelf.width / max(columns - 2, 1), shelf.depth / max(rows - 2, 1) / HEIGHT_OF_LETTER)
    across, deep = round(shelf.width / cell), round(shelf.depth / cell / HEIGHT_OF_LETTER)
    xs = (np.arange(deep)[::-1] + 0.5) * shelf.depth / deep
    ys = (np.arange(across)[::-1] + 0.5) * shelf.width / across
    letters, kinds = _drawn(question, np.stack(np.meshgrid(xs, ys, indexing="ij"), axis=-1))
    picture = Text("+" + "-" * across + f"+ x = {shelf.depth:g} m\n")
    for row in range(deep):
        picture.append("|")
        for kind, cells in groupby(zip(kinds[row], letters[row], strict=True), key=itemgetter(0)):
            picture.append("".join(letter for _, letter in cells), STYLES.get(kind, ""))
        picture.append("|\n")
    scale = f"y = {shelf.width:g} m"
    return picture.append(scale + "0".rjust(across + 2 - len(scale)) + "  x = 0: the mouth")


def _drawn(question: Question, centers: FloatArray) -> tuple[list[list[str]], list[list[str]]]:
    """The letter of each cell, and what it belongs to, for the cells' centres ``(rows, columns, 2)`` (m)."""
    scene, state = question.scene, question.state
    kinds = np.where(_inside(centers, question.corridor), CORRIDOR, FREE)
    letters = kinds.copy()
    for row, name in enumerate(scene.ids):
        if not state.on_board[row]:
            continue
        kind = TARGET if name == scene.target else BLOCKER if name == question.blocker else OBSTACLE
        distances = np.linalg.norm(centers - state.positions[row], axis=-1)
        covered = distances <= max(float(scene.radii[row]), float(distances.min()))
        letters[covered] = kinds[covered] = kind
    for row, (name, label) in enumerate(labels(scene).items()):
        if state.on_board[row]:
            _put(letters, np.linalg.norm(centers - state.positions[scene.index(name)], axis=-1), label)
    return letters.tolist(), kinds.tolist()


def _put(letters: FloatArray, distances: FloatArray, label: str) -> None:
    """Write a label over the cell that is nearest, and those beside it, within the picture."""
    row, column = np.unravel_index(int(distances.argmin()), distances.shape)
    first = min(max(int(column) - (len(label) - 1) // 2, 0), max(letters.shape[1] - len(label), 0))
    for offset, letter in enumerate(label[: letters.shape[1]]):
        letters[row, first + offset] = letter


def _inside(points: FloatArray, corners: FloatArray) -> FloatArray:
    """Whether points ``(..., 2)`` are inside a convex polygon ``(k, 2)``, counter-clockwise."""
    edges = np.roll(corners, -1, axis=0) - corners
    offset = points[..., None, :] - corners
    return np.asarray((edges[:, 0] * offset[..., 1] - edges[:, 1] * offset[..., 0] >= 0.0).all(axis=-1))
