"""Makes every picture of README and docs anew: ``python -m docs.make_pictures``, or some: ``... baxter.webp``.

Each is made by a command that it says first, so that anybody can make one like it.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from docs.chromium import find_chromium
from docs.experiment_picture import FIGURES

HERE = Path(__file__).parent / "images"
SOLVE = "phframe solve vieira/basic"
PICTURES = {
    "basic-in-rerun.png": (
        f"{SOLVE} --rerun --out {{scratch}}/run",
        "python -m docs.screenshot {scratch}/run/recording.rrd {picture} --at 0.17",
    ),
    "basic-decisions.png": ("python docs/examples/draw_decisions.py {picture}",),
    "sure-search.png": ("python docs/examples/draw_search.py {picture}",),
    "dense-scene.png": ("phframe scenes dense/9 --out {picture} --force",),
    "basic-in-mujoco.webp": (f"{SOLVE} --backend mujoco --no-rerun --out {{scratch}}/run --video {{picture}}",),
    "baxter.webp": (
        "phframe solve papallas/s08 --planner sure --backend mujoco --arm baxter --no-rerun --out {scratch}/run --video {picture}",
    ),
    **dict.fromkeys(FIGURES, ("python docs/experiment_picture.py {picture}",)),
}
"""How each is made, command by command."""


def main(names: Sequence[str]) -> int:
    """Make the pictures named, or all; how many could not be made."""
    if strange := set(names) - set(PICTURES):
        sys.stderr.write(f"no picture {', '.join(sorted(strange))}; there is: {', '.join(PICTURES)}\n")
        return 2
    return sum(not _make(name) for name in names or PICTURES)


def _make(name: str) -> bool:
    commands = PICTURES[name]
    if any("docs.screenshot" in command for command in commands) and find_chromium() is None:
        sys.stderr.write(f"{name}: left as it is, since Chromium is not installed (Debian: apt-get install chromium)\n")
        return False
    with tempfile.TemporaryDirectory() as scratch:
        return all(_run(name, command.format(scratch=scratch, picture=HERE / name)) for command in commands)


def _run(name: str, command: str) -> bool:
    sys.stdout.write(f"{name}: {command}\n")
    sys.stdout.flush()
    program, *arguments = command.split()
    before = [sys.executable] if program == "python" else [sys.executable, "-m", program]
    return subprocess.run([*before, *arguments], stdout=subprocess.DEVNULL, check=False).returncode == 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
