"""What ``phframe arm reach`` does."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import numpy as np

from phframe.cli.console import emit, error_console
from phframe.cli.needs import require
from phframe.cli.output import Output
from phframe.core import BasePose, InputError, Scene, Unreachable
from phframe.core.paths import path_shown
from phframe.core.scene_check import base_pose_faults
from phframe.core.variant import variant_name
from phframe.motion.reachability import Reachability, reachability
from phframe.runtime.mounting import arm_in
from phframe.runtime.scenes import find_scene

FORMAT = 2
"""Of the JSON object."""
PICTURE = ".png"
"""How the name of a picture ends."""


def run(
    arm_name: str,
    scene_name: str,
    mount: tuple[float, float, float, float] | None,
    out: str | None,
    options: Mapping[str, Mapping[str, str]],
    *,
    as_json: bool,
    force: bool,
) -> None:
    """Print the fractions, and draw the map if that is wanted.

    Args:
        arm_name: A name, or a class in a file.
        scene_name: A name, or a file.
        mount: Where the base stands: x, y, z (m), yaw (rad); None: as the scene or the arm has it.
        out: The picture; None: none.
        options: As text, by part and key.
        as_json: Whether to print JSON.
        force: Whether a file may be overwritten.

    Raises:
        PhframeError: If something asked for cannot be used; nothing was written then.
    """
    given = None if mount is None else _base_pose(*mount)
    output = _output(out, force=force)
    scene = find_scene(scene_name, options["scenes"])
    with error_console().status("Loading the libraries") as status:
        arm, own = arm_in(
            scene,
            arm_name,
            options["arm"],
            lambda done, of: status.update(f"Looking where the base has to stand: {done} of {of}"),
        )
        base_pose = given or own
        status.update("Looking over how much of the shelf it reaches")
        reach = reachability(scene.shelf, arm, base_pose)
        beyond = arm.out_of_reach(scene, scene.initial_state(), base_pose, scene.target)
    if output is not None:
        from phframe.cli.reach_map import reach_picture

        output.write(reach_picture(reach, scene, f"{arm_name} in {scene.name}"))
    name = variant_name(arm_name, arm.options.model_dump(mode="json", exclude_defaults=True, exclude={"mount"}))
    fractions = _fractions(name, scene, base_pose, reach, beyond)
    emit(json.dumps(fractions, allow_nan=False) if as_json else _sentence(fractions))


def _base_pose(x: float, y: float, z: float, yaw: float) -> BasePose:
    base_pose = BasePose(x, y, z, yaw)
    for fault in base_pose_faults("--mount", base_pose):
        raise InputError(fault)
    return base_pose


def _output(out: str | None, *, force: bool) -> Output | None:
    if out is None:
        return None
    if not out.lower().endswith(PICTURE):
        raise InputError(f"the map is a picture, and {path_shown(out)!r} is no name of one: give --out FILE{PICTURE}")
    require("matplotlib", "the map of what an arm reaches", "plots")
    return Output(out, force=force)


def _fractions(
    arm: str, scene: Scene, base_pose: BasePose, reach: Reachability, beyond: Unreachable | None
) -> dict[str, Any]:
    known = np.isfinite(reach.yaws)
    return {
        "format": FORMAT,
        "arm": arm,
        "scene": scene.name,
        "mount": [base_pose.x, base_pose.y, base_pose.z, base_pose.yaw],
        "fraction": reach.fraction,
        "straight": float((reach.yaws == 0.0).mean()),
        "depths": [round(depth, 6) for depth in reach.depths.tolist()],
        "fraction_at_depth": known.mean(axis=0).tolist(),
        "target_out_of_reach": None if beyond is None else beyond.why,
    }


def _sentence(fractions: Mapping[str, Any]) -> str:
    x, y, z, yaw = fractions["mount"]
    beyond = fractions["target_out_of_reach"]
    target = "" if beyond is None else f"; its target is out of reach at every yaw: {beyond}"
    return (
        f"{fractions['arm']} with its base at x {x:.3f}, y {y:.3f}, z {z:.3f} m, yaw {yaw:.3f} rad reaches "
        f"{fractions['fraction']:.1%} of the shelf of {fractions['scene']}, {fractions['straight']:.1%} without turning "
        f"the gripper{target}"
    )
