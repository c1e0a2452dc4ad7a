"""``phframe arm``: what concerns one arm."""

from __future__ import annotations

import math
from typing import Annotated

import typer

from phframe.cli import completion
from phframe.cli.exit_codes import ExitCode
from phframe.cli.options import only_parts, parse_options

app = typer.Typer(help="What concerns one arm: what it reaches.", invoke_without_command=True)


@app.callback()
def _top(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())
        raise typer.Exit(ExitCode.BAD_INPUT)


def _finite(values: tuple[float, ...] | None) -> tuple[float, ...] | None:
    if values is not None and not all(map(math.isfinite, values)):
        raise typer.BadParameter("all four must be finite numbers.")
    return values


Arm = Annotated[
    str,
    typer.Option(
        "--arm",
        metavar="NAME",
        help="The robot arm: a name ('phframe arms') or ./mine.py:Mine.",
        autocompletion=completion.arms,
    ),
]
SceneSpec = Annotated[
    str,
    typer.Option(
        "--scene",
        metavar="SCENE",
        help="Whose shelf: a scene such as vieira/basic, or a scene file.",
        autocompletion=completion.scenes,
    ),
]
BasePose = Annotated[
    tuple[float, float, float, float] | None,
    typer.Option(
        "--mount",
        metavar="X Y Z YAW",
        callback=_finite,
        help="Where the base stands in the shelf frame (m, rad).",
        show_default="as the scene says, else the arm's own",
    ),
]
Out = Annotated[
    str | None,
    typer.Option("--out", metavar="PNG", help="Picture of the map to write (extra 'plots').", show_default="none"),
]
OptionTexts = Annotated[
    list[str] | None,
    typer.Option(
        "--option",
        metavar="KEY=VALUE",
        help="An option of the arm or of the suite of scenes: arm.link_width=0.1, scenes.depth=0.6. Repeatable.",
        autocompletion=completion.options,
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print the fractions as one JSON object instead of a sentence.")]
Force = Annotated[bool, typer.Option("--force", help="Overwrite a picture that is there.")]


@app.command(
    "reach",
    epilog="Example: phframe arm reach --arm baxter --scene papallas/s02 --mount -0.8 -0.05 -0.15 0 --out reach.png",
)
def reach(
    arm: Arm = "planar",
    scene: SceneSpec = "vieira/basic",
    base_pose: BasePose = None,
    out: Out = None,
    option: OptionTexts = None,
    as_json: Json = False,
    force: Force = False,
) -> None:
    """Say over how much of a shelf an arm can have its fingertip, and draw it.

    The gripper is level, in its plane above the board, and turned by no more than 30 degrees.
    """
    options = only_parts(parse_options(option or ()), "arm", "scenes")
    from phframe.cli.reaching import ReachRequest, run  # heavy, and not needed where the options are wrong

    run(ReachRequest(arm, scene, base_pose, out, options, as_json, force))
