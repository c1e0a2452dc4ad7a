"""``phframe scene``: what concerns one scene."""

from __future__ import annotations

from typing import Annotated

import typer

from phframe.cli.exit_codes import ExitCode

app = typer.Typer(help="What concerns one scene: import it from another program.", invoke_without_command=True)


@app.callback()
def _top(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())
        raise typer.Exit(ExitCode.BAD_INPUT)


File = Annotated[str, typer.Argument(metavar="FILE", help="A MuJoCo XML file.")]
Out = Annotated[str, typer.Option("--out", metavar="FILE", help="Scene file to write; - is standard output.")]
Target = Annotated[
    str | None,
    typer.Option(
        "--target",
        metavar="NAME",
        help="The body that is to be taken out.",
        show_default="what the file says, else what is named like a target or goal, else the first",
    ),
]
Name = Annotated[
    str | None,
    typer.Option("--name", metavar="NAME", help="What the scene is to be called.", show_default="as the model"),
]
Force = Annotated[bool, typer.Option("--force", help="Overwrite a file that is there.")]


@app.command("import", epilog="Example: phframe scene import cabinet.xml --target mug --out cabinet.yaml")
def import_scene(file: File, out: Out = "-", target: Target = None, name: Name = None, force: Force = False) -> None:
    """Make a scene file of a MuJoCo XML of others (extra 'mujoco').

    Free bodies with a cylinder or box become objects, boxes and planes fixed to the world the shelf, which may stand and be
    turned anywhere. What was decided and what was ignored is said on standard error.
    """
    from phframe.cli.importing import run

    run(file, out, target, name, force=force)
