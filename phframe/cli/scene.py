"""``phframe scene``: what concerns one scene."""

from __future__ import annotations

from typing import Annotated

import typer

from phframe.cli.flags import flag
from phframe.cli.group import show_help

app = typer.Typer(
    help="What concerns one scene: import it from another program.", invoke_without_command=True, callback=show_help
)

File = Annotated[str, typer.Argument(metavar="FILE", help="A MuJoCo XML file.")]
Out = Annotated[str, flag("FILE", "Scene file to write; - is standard output.")]
Target = Annotated[
    str | None,
    flag(
        "NAME",
        "The body that is to be taken out.",
        "what the file says, else what is named like a target or goal, else the first",
    ),
]
Name = Annotated[str | None, flag("NAME", "What the scene is to be called.", "as the model")]
Force = Annotated[bool, typer.Option("--force", help="Overwrite a file that is there.")]


@app.command("import", epilog="Example: phframe scene import cabinet.xml --target mug --out cabinet.yaml")
def import_scene(file: File, out: Out = "-", target: Target = None, name: Name = None, force: Force = False) -> None:
    """Make a scene file of a MuJoCo XML of others (extra 'mujoco').

    Free bodies with a cylinder or box become objects, boxes and planes fixed to the world the shelf, which may stand and be
    turned anywhere. What was decided and what was ignored is said on standard error.
    """
    from phframe.cli.importing import run

    run(file, out, target, name, force=force)
