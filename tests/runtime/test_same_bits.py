"""A plan and what comes of it are the same bits whatever sets of instructions the libraries of linear algebra use."""

from __future__ import annotations

import os
import platform
import subprocess
import sys

import pytest

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="the instructions are those of x86-64"),
]
SOLVE = """
import hashlib, sys, phframe
found = hashlib.sha256()
for scene, planner in (("papallas/s02", "sure"), ("papallas/s08", "phia")):
    episode = phframe.solve(scene, planner=planner)
    for plan in episode.plans:
        for action, expected in zip(plan.actions, plan.expected, strict=True):
            found.update(action.path.poses.tobytes() + expected.poses.tobytes())
    for step in episode.steps:
        found.update(step.after.poses.tobytes())
print(found.hexdigest())
"""
PROCESSORS = {
    "as it is": {},
    "without fused products and sums": {"OPENBLAS_CORETYPE": "Sandybridge"},
    "of 2008": {"OPENBLAS_CORETYPE": "Nehalem", "NPY_DISABLE_CPU_FEATURES": "X86_V3"},
}


def test_sums_do_not_depend_on_the_processor() -> None:
    running = [
        subprocess.Popen(
            [sys.executable, "-W", "ignore", "-c", SOLVE],
            env={**os.environ, **set_up},
            stdout=subprocess.PIPE,
            text=True,
        )
        for set_up in PROCESSORS.values()
    ]
    found = [process.communicate(timeout=240)[0] for process in running]
    assert [process.returncode for process in running] == [0, 0, 0]
    assert len(set(found)) == 1, dict(zip(PROCESSORS, found, strict=True))
