"""Reads MuJoCo XML of others: MuJoCo itself resolves includes, defaults, units and nesting; what counts is picked out.

Free bodies are objects, boxes and planes fixed to the world may be a shelf. Everything else is ignored, and said to be.
"""

from __future__ import annotations

import json
import warnings
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from phframe.core import FloatArray, InputError, PhframeError, SceneError, yaw_of
from phframe.core.bounded_process import answer
from phframe.core.paths import path_shown, user_path
from phframe.core.regular_file import read_regular_file
from phframe.scenes.foreign import Block, ForeignScene, FreeBody, listed
from phframe.scenes.foreign_file import ForeignReading
from phframe.scenes.mjcf import MOUNT_PREFIX, TARGET_KEY

MAX_BYTES = 20_000_000
"""Larger files are refused unread."""
MAX_COPIES = 10_000
"""Of what a file asks to be repeated."""
LEAST_MASS = 1e-6
"""Of what has lost its mesh (kg, and for its inertia kg m^2)."""
UPRIGHT = 0.996
"""Cosine of the greatest tilt of an object's axis (5 degrees)."""
ENDLESS = 1e3
"""Half the size of the box that stands for a plane's half-space (m)."""
_SHAPES = {
    int(getattr(mujoco.mjtGeom, f"mjGEOM_{name.upper()}")): name
    for name in ("plane", "hfield", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh", "sdf")
}


def read_mjcf(path: str | Path, source: str | None = None) -> ForeignScene:
    """What is in a MuJoCo XML file, read in this process; of files that are not known, ``read_foreign`` is the way.

    Args:
        path: The file.
        source: What it is called in errors; None: its path.

    Raises:
        InputError: If the file cannot be read.
        SceneError: If MuJoCo cannot make a model of it.
    """
    source, file = source or path_shown(path), user_path(path)
    _refuse_unreasonable(_content(file, source), source)
    try:
        return _read(file, source)
    except (PhframeError, MemoryError):
        raise
    except Exception as error:  # noqa: BLE001 - MuJoCo meets files of any kind, and whatever it raises is about that file
        raise SceneError(f"MuJoCo cannot make a model of it: {_in_a_line(error)}", source) from None


def _read(file: Path, source: str) -> ForeignScene:
    with _quiet():
        model, lost = _compiled(file, source)
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
    if np.hypot(*model.opt.gravity[:2]) > 1e-6 or model.opt.gravity[2] > 0.0:
        raise SceneError(
            f"gravity is {model.opt.gravity.tolist()}; it must point along -z, as shelves stand upright", source
        )
    figures = (data.geom_xpos, data.geom_xmat, model.geom_size, model.geom_friction, model.body_subtreemass)
    if not all(np.isfinite(array).all() for array in figures):
        raise SceneError("it holds places, sizes, masses or frictions that are not finite numbers", source)
    return _Reading(model, data, lost).scene()


def _content(file: Path, source: str) -> bytes:
    try:
        content = read_regular_file(file, MAX_BYTES + 1)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(f"cannot read {source}: {reason[:1].lower()}{reason[1:]}") from None
    if len(content) > MAX_BYTES:
        raise SceneError(f"larger than {MAX_BYTES // 1_000_000} MB; that is no scene", source)
    return content


def _refuse_unreasonable(content: bytes, source: str) -> None:
    """Refuse what is no MuJoCo XML, and what would be copied beyond measure."""
    try:
        root = ET.fromstring(content)
    except (ET.ParseError, ValueError) as error:
        raise SceneError(f"not valid XML: {error}", source) from None
    if root.tag != "mujoco":
        raise SceneError(f"its root is <{root.tag[:40]}>; expected MuJoCo XML, which begins with <mujoco>", source)
    waiting = [(root, 1)]
    while waiting:
        element, copies = waiting.pop()
        copies *= _copies(element)
        if copies > MAX_COPIES:
            raise SceneError(f"<{element.tag}> asks for {copies} copies; at most {MAX_COPIES} are made", source)
        waiting += [(child, copies) for child in element]


def _copies(element: ET.Element) -> int:
    product = 1
    for word in element.get("count", "").split():
        product *= int(word) if word.isascii() and word.isdigit() and len(word) < 12 else 1
    return max(product, 1)


@contextmanager
def _quiet() -> Iterator[None]:
    """MuJoCo's warnings go nowhere: it would write them to the screen and into a file in the current directory."""
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda _: None)
    try:
        with warnings.catch_warnings():  # compiling warns in Python's way
            warnings.simplefilter("ignore")
            yield
    finally:
        mujoco.set_mju_user_warning(before)


def _compiled(file: Path, source: str) -> tuple[Any, str]:
    """The model; where files are missing for meshes and pictures, the model without them, and what was missing."""
    try:
        spec = mujoco.MjSpec.from_file(str(file))
    except ValueError as error:
        raise SceneError(f"MuJoCo cannot read it: {_in_a_line(error)}", source) from None
    try:
        return spec.compile(), ""
    except ValueError as error:
        lost = _in_a_line(error)
    if any((spec.meshes, spec.hfields, spec.textures, spec.skins)):
        for least in (0.0, LEAST_MASS):  # what was but a mesh has no mass left
            with suppress(ValueError):
                return _without_assets(mujoco.MjSpec.from_file(str(file)), least).compile(), lost
    raise SceneError(f"MuJoCo cannot make a model of it: {lost}", source)


def _without_assets(spec: Any, least: float) -> Any:
    """A spec without all that comes from further files, in which nothing that moves has less than a least mass (kg)."""
    kinds = (mujoco.mjtGeom.mjGEOM_MESH, mujoco.mjtGeom.mjGEOM_HFIELD, mujoco.mjtGeom.mjGEOM_SDF)
    for geom in list(spec.geoms):
        geom.material = ""
        if geom.type in kinds:
            spec.delete(geom)
    for site in spec.sites:
        site.material = ""
    for each in [*spec.skins, *spec.materials, *spec.textures, *spec.meshes, *spec.hfields]:
        spec.delete(each)
    spec.compiler.boundmass = spec.compiler.boundinertia = least
    return spec


def _in_a_line(error: Exception) -> str:
    return " ".join(str(error).split())[:300]


class _Reading:
    """Picks out of a model what may belong to a scene."""

    def __init__(self, model: Any, data: Any, lost: str) -> None:
        self._model, self._data = model, data
        self._ignored = [f"all meshes, height fields and materials, since one does not load ({lost})"] if lost else []

    def scene(self) -> ForeignScene:
        model = self._model
        free = [int(model.jnt_bodyid[row]) for row in range(model.njnt) if model.jnt_type[row] == 0]
        bodies = tuple(body for each in free if (body := self._body(each)) is not None)
        blocks = tuple(self._block(row) for row in range(model.ngeom) if self._may_be_wall(row))
        self._ignore_geoms(free)
        self._ignore_rest(len(free))
        name = bytes(model.names).split(b"\0", 1)[0].decode("utf-8", "replace")
        return ForeignScene(name, blocks, bodies, self._target(), self._base_poses(), tuple(self._ignored))

    def _may_be_wall(self, row: int) -> bool:
        return self._is_fixed(row) and self._collides(row) and self._shape(row) in ("box", "plane")

    def _is_fixed(self, row: int) -> bool:
        return int(self._model.body_weldid[self._model.geom_bodyid[row]]) == 0

    def _collides(self, row: int) -> bool:
        return bool(self._model.geom_contype[row] or self._model.geom_conaffinity[row])

    def _shape(self, row: int) -> str:
        return _SHAPES.get(int(self._model.geom_type[row]), "unknown")

    def _geom_name(self, row: int) -> str:
        geom = self._model.geom(row)
        return str(geom.name or self._model.body(int(geom.bodyid[0])).name or f"{self._shape(row)} {row}")

    def _axes(self, row: int) -> FloatArray:
        return np.asarray(self._data.geom_xmat[row]).reshape(3, 3)

    def _block(self, row: int) -> Block:
        axes, center, half = self._axes(row), self._data.geom_xpos[row], self._model.geom_size[row]
        endless = self._shape(row) == "plane"
        if endless:
            center, half = center - ENDLESS * axes[:, 2], np.full(3, ENDLESS)
        friction, priority = float(self._model.geom_friction[row, 0]), int(self._model.geom_priority[row])
        return Block(self._geom_name(row), center, axes, half, friction, priority, endless)

    def _body(self, number: int) -> FreeBody | None:
        name = str(self._model.body(number).name or f"body_{number}")
        rows = [
            row for row in range(self._model.ngeom) if self._model.body_weldid[self._model.geom_bodyid[row]] == number
        ]
        solid = [row for row in rows if self._collides(row)] or rows
        fitting = [row for row in solid if self._shape(row) in ("cylinder", "box")]
        if not fitting:
            shapes = Counter(self._shape(row) for row in solid)
            self._ignored.append(f"the free body {name!r}: no cylinder or box ({', '.join(shapes) or 'no shape'})")
            return None
        row = max(fitting, key=lambda each: (self._shape(each) == "cylinder", self._volume(each)))
        figures = self._figures(row)
        if figures is None:
            self._ignored.append(f"the free body {name!r}: it does not stand upright")
            return None
        if self._shape(row) == "box":
            self._ignored.append(f"the corners of the box {name!r}: it is taken as the upright cylinder around it")
        if others := [each for each in solid if each != row and not self._same(each, row)]:
            self._ignored.append(f"{len(others)} smaller geoms of {name!r}: only its largest {self._shape(row)} counts")
        foot = max(
            (each for each in solid if self._same(each, row)), key=lambda each: int(self._model.geom_priority[each])
        )
        return FreeBody(
            name,
            self._data.geom_xpos[row],
            yaw_of(np.concatenate([np.zeros(3), self._data.xquat[number]])),
            *figures,
            float(self._model.body_subtreemass[number]),
            float(self._model.geom_friction[foot, 0]),
            int(self._model.geom_priority[foot]),
        )

    def _volume(self, row: int) -> float:
        a, b, c = self._model.geom_size[row]
        return float(8.0 * a * b * c if self._shape(row) == "box" else 2.0 * np.pi * a * a * b)

    def _same(self, one: int, other: int) -> bool:
        """Whether two geoms fill the same space."""
        return (
            self._shape(one) == self._shape(other)
            and np.allclose(self._model.geom_size[one], self._model.geom_size[other])
            and np.allclose(self._data.geom_xpos[one], self._data.geom_xpos[other])
        )

    def _figures(self, row: int) -> tuple[float, float] | None:
        """Radius and height (m) of the upright cylinder that a geom is, or that is around it."""
        vertical, size = np.abs(self._axes(row)[2]), self._model.geom_size[row]
        axis = 2 if self._shape(row) == "cylinder" else int(np.argmax(vertical))
        if vertical[axis] < UPRIGHT:
            return None
        if self._shape(row) == "cylinder":
            return float(size[0]), 2.0 * float(size[1])
        return float(np.hypot(*np.delete(size, axis))), 2.0 * float(size[axis])

    def _target(self) -> str:
        row = mujoco.mj_name2id(self._model, mujoco.mjtObj.mjOBJ_TEXT, TARGET_KEY)
        if row < 0:
            return ""
        start = int(self._model.text_adr[row])
        return bytes(self._model.text_data[start:]).split(b"\0", 1)[0].decode("utf-8", "replace")

    def _base_poses(self) -> dict[str, FloatArray]:
        """Of arms, as ``phframe export`` writes them."""
        found = {}
        for row in range(self._model.nsite):
            name = str(self._model.site(row).name)
            if name.startswith(MOUNT_PREFIX):
                axes = self._data.site_xmat[row].reshape(3, 3)
                yaw = np.arctan2(axes[1, 0], axes[0, 0])
                found[name.removeprefix(MOUNT_PREFIX)] = np.array([*self._data.site_xpos[row], yaw])
        return found

    def _ignore_geoms(self, free: list[int]) -> None:
        moved = Counter[str]()
        others: dict[str, list[str]] = {}
        for row in range(self._model.ngeom):
            if self._is_fixed(row):
                if not self._may_be_wall(row):
                    kind = (
                        f"fixed {self._shape(row)}" if self._collides(row) else "fixed geom that collides with nothing"
                    )
                    others.setdefault(kind, []).append(self._geom_name(row))
            elif self._model.body_weldid[self._model.geom_bodyid[row]] not in free:
                moved[str(self._model.body(int(self._model.body_rootid[self._model.geom_bodyid[row]])).name)] += 1
        self._ignored += [f"{kind} {listed(names)}" for kind, names in others.items()]
        self._ignored += [f"{count} geoms moved by joints, of {name!r}" for name, count in moved.items()]

    def _ignore_rest(self, free: int) -> None:
        model = self._model
        counts = {
            "joints besides the free ones": model.njnt - free,
            "actuators": model.nu,
            "tendons": model.ntendon,
            "equality constraints": model.neq,
            "flexible bodies": model.nflex,
            "keyframes, so that all is taken as it stands without": model.nkey,
        }
        self._ignored += [f"{what}: {count}" for what, count in counts.items() if count]


def _reading(question: bytes) -> bytes:
    path, source = json.loads(question)
    try:
        reading = ForeignReading(read_mjcf(path, source))
    except SceneError as error:
        reading = ForeignReading(problems=error.problems)
    except PhframeError as error:
        reading = ForeignReading(unreadable=str(error))
    return reading.to_json()


if __name__ == "__main__":
    answer(_reading)
