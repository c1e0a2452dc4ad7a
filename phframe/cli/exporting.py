"""What ``phframe export`` does: find what is meant, check what is asked for, write it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from phframe.cli.episodes import read_episode
from phframe.cli.export_formats import FORMATS, Format
from phframe.cli.needs import require
from phframe.cli.output import STANDARD_OUTPUT, Output
from phframe.core import ArmModel, BasePose, Episode, InputError, OptionError, Scene, UnknownNameError
from phframe.core.paths import user_path
from phframe.registry import Kind, create
from phframe.runtime.mounting import arm_in

ARM_FILE = "arm.urdf"


@dataclass(frozen=True, slots=True)
class ExportRequest:
    """What ``phframe export`` was asked for.

    Attributes:
        what: A scene or an episode.
        format_name: Of the output; None: what suits.
        out: A path, or ``-``.
        arm: A name, or a class in a file; None: no arm.
        options: As text, by part and key.
        action: Number of the only action wanted; None: all.
        force: Whether files may be overwritten.
    """

    what: str
    format_name: str | None
    out: str
    arm: str | None
    options: Mapping[str, Mapping[str, str]]
    action: int | None
    force: bool


def run(wanted: ExportRequest) -> None:
    """Write what is wanted.

    Raises:
        PhframeError: If something asked for cannot be used; nothing was written then.
    """
    subject = _find(wanted)
    form = _form(wanted, subject)
    _check(wanted, subject, form)
    output = Output(wanted.out, force=wanted.force, folder=form.folder)
    if form.of_episode:
        assert isinstance(subject, Episode), "checked"
        output.write(_trajectories(subject, wanted, form))
        return
    scene = subject.scene if isinstance(subject, Episode) else subject
    if form.folder:
        output.write_folder(_parts(scene, wanted))
    else:
        output.write(_scene_text(scene, wanted, form))


def _find(wanted: ExportRequest) -> Scene | Episode:
    from phframe.runtime.scenes import find_scene

    path = user_path(wanted.what)
    try:
        is_run = path.is_dir()
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror}") from None
    if is_run or wanted.what.endswith(".json"):
        return read_episode(path)
    return find_scene(wanted.what, wanted.options["scenes"])


def _form(wanted: ExportRequest, subject: Scene | Episode) -> Format:
    name = wanted.format_name
    if name is None:
        suffix = Path(wanted.out).suffix.lower()
        fitting = [known for known, form in FORMATS.items() if form.suffix == suffix and suffix]
        name = fitting[0] if fitting else "json" if isinstance(subject, Episode) else "mjcf"
    if name not in FORMATS:
        raise UnknownNameError("export format", name, FORMATS)
    return FORMATS[name]


def _check(wanted: ExportRequest, subject: Scene | Episode, form: Format) -> None:
    episode = isinstance(subject, Episode)
    if form.of_episode and not episode:
        raise InputError(
            f"{wanted.what} is a scene, and {form.name} is for the trajectories of an episode. Take a directory that "
            "'phframe solve' made, or --format mjcf, urdf or urdf-parts."
        )
    if form.folder and wanted.out == STANDARD_OUTPUT:
        raise InputError(f"{form.name} is a folder of files: name it with --out DIR")
    if wanted.arm is not None and not form.with_arm:
        raise OptionError(f"--arm goes with mjcf and urdf-parts, not with {form.name}")
    if wanted.options["arm"] and wanted.arm is None and not form.of_episode:
        raise OptionError("there are options of an arm, and no arm. Name it with --arm NAME.")
    if wanted.action is not None and not form.of_episode:
        raise OptionError(f"--action goes with json and csv, not with {form.name}")


def _trajectories(episode: Episode, wanted: ExportRequest, form: Format) -> str:
    from phframe.runtime.joint_trajectories import as_csv, as_json, joint_trajectories, refuse_no_joints

    refuse_no_joints(episode)
    options = {**episode.spec.options.get("arm", {}), **wanted.options["arm"]}
    arm = create(Kind.ARM, wanted.arm or episode.spec.arm, options)
    found = joint_trajectories(episode, arm, wanted.action)
    return as_csv(found) if form.name == "csv" else as_json(episode, found)


def _scene_text(scene: Scene, wanted: ExportRequest, form: Format) -> str:
    if form.name == "urdf":
        from phframe.scenes.urdf import scene_to_urdf

        return scene_to_urdf(scene)
    from phframe.scenes.mjcf import scene_to_mjcf

    text = scene_to_mjcf(scene)
    if wanted.arm is None:
        return text
    require("mujoco", "an arm in MJCF", "mujoco")
    from phframe.backends.mujoco_.export import with_arm

    arm, base_pose = _arm(scene, wanted)
    return with_arm(text, arm, base_pose)


def _parts(scene: Scene, wanted: ExportRequest) -> dict[str, str]:
    from phframe.scenes.urdf import LIST_FILE, scene_parts

    parts = scene_parts(scene)
    if wanted.arm is None:
        return parts
    arm, base_pose = _arm(scene, wanted)
    x, y, z, w, *vector = (float(number) for number in base_pose.pose)
    listed = {**json.loads(parts[LIST_FILE]), "arm": {"urdf": ARM_FILE, "position": [x, y, z]}}
    listed["arm"]["orientation"] = [*vector, w]
    return {**parts, ARM_FILE: arm.urdf(), LIST_FILE: json.dumps(listed, indent=1) + "\n"}


def _arm(scene: Scene, wanted: ExportRequest) -> tuple[ArmModel[Any], BasePose]:
    assert wanted.arm is not None, "asked for"
    return arm_in(scene, wanted.arm, wanted.options["arm"])
