"""Makes a picture of ``experiment.md``, by the bench that the page names: ``python docs/experiment_picture.py FILE``.

The bench goes on where it was, in ``runs/``; from nothing it takes minutes.
"""

from __future__ import annotations

import shlex
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
FIGURES = {
    "experiment-bars.png": ("runs/paper", "bars-pymunk-with-planar.png"),
    "experiment-solved-over-time.png": ("runs/paper", "solved-over-time-pymunk-with-planar.png"),
    "experiment-profile.png": ("runs/paper", "profile-pymunk-with-planar.png"),
    "experiment-bars-mujoco.png": ("runs/paper-mujoco", "bars-mujoco-with-planar-planned-in-fast.png"),
}
"""The bench and the figure of its report that each is."""


def main(picture: Path) -> None:
    """Run the bench, have its figures made, and take one of them."""
    results, figure = FIGURES[picture.name]
    lines = (HERE / "experiment.md").read_text("utf-8").splitlines()
    (bench,) = (line for line in lines if line.startswith("$ phframe bench") and line.endswith(f"--out {results}"))
    report = f"phframe report {results} --out {results}/report.html --figures {results}/figures --force"
    for command in (bench.removeprefix("$ "), report):
        subprocess.run([sys.executable, "-m", *shlex.split(command)], cwd=HERE.parent, check=True)
    shutil.copyfile(HERE.parent / results / "figures" / figure, picture)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
