"""``phframe arm``: what concerns one arm."""

from __future__ import annotations

from typing import Annotated

import typer

from phframe.cli import completion
from phframe.cli.flags import Arm, finite, flag
from phframe.cli.group import show_help
from phframe.cli.options import only_parts, parse_options

app = typer.Typer(help="What concerns one arm: what it reaches.", invoke_without_command=True, callback=show_help)

SceneSpec = Annotated[
    str, flag("SCENE", "Whose shelf: a scene such as vieira/basic, or a scene file.", autocompletion=completion.scenes)
]
BasePose = Annotated[
    tuple[float, float, float, float] | None,
    flag(
        "X Y Z YAW",
        "Where the base stands in the shelf frame (m, rad).",
        "as the scene says, else the arm's own",
        callback=finite,
    ),
]
Out = Annotated[str | None, flag("PNG", "Picture of the map to write (extra 'plots').", "none")]
OptionTexts = Annotated[
    list[str] | None,
    flag(
        "KEY=VALUE",
        "An option of the arm or of the suite of scenes: arm.link_width=0.1, scenes.depth=0.6. Repeatable.",
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
    mount: BasePose = None,
    out: Out = None,
    option: OptionTexts = None,
    as_json: Json = False,
    force: Force = False,
) -> None:
    """Say over how much of a shelf an arm gets its fingertip straight in through the mouth, and draw it.

    The gripper is level, in its plane above the board, and turned by no more than 40 degrees; nothing stands in the shelf.
    An arm of joints must follow the way with no link meeting the shelf. With --option arm.mount=auto its base stands
    where the scene's target is reached best.
    """
    options = only_parts(parse_options(option or ()), "arm", "scenes")
    from phframe.cli.reaching import run  # heavy, and not needed where the options are wrong

    run(arm, scene, mount, out, options, as_json=as_json, force=force)
