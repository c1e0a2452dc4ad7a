"""What the documentation shows is so: links and pictures, code, scenes, command lines and examples."""

from __future__ import annotations

import re
import shlex
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import typer

import phframe
from phframe import testing
from phframe.bench.meters.__main__ import command_line
from phframe.bench.selection import select_problems
from phframe.cli.export_formats import FORMATS
from phframe.cli.main import app
from phframe.cli.option_list import describe
from phframe.cli.options import parse_options
from phframe.core import Episode, NotInstalledError, Status
from phframe.registry import Kind, create, load
from phframe.registry.from_file import load_from_file
from phframe.runtime.scenes import find_scene
from phframe.scenes import parse_scene
from tests.markdown import (
    DOCS,
    EXAMPLES,
    PAGES,
    README,
    ROOT,
    Block,
    anchors,
    blocks,
    each_block,
    each_page,
    extras,
    marks_of,
    named,
    prose_of,
    quoted,
    text_of,
)

LINKING = [*PAGES, ROOT / "CONTRIBUTING.md", *sorted(ROOT.glob("plugins/*/README.md"))]


@pytest.fixture(scope="module")
def episode() -> Episode:
    return phframe.solve("vieira/basic")


@each_page(LINKING)
def test_relative_links_resolve(page: Path) -> None:
    for target in re.findall(r"\]\(([^)\s]+)\)", prose_of(page)):
        if re.match(r"[a-z]+:", target):
            continue
        path, _, anchor = target.partition("#")
        linked = (page.parent / path).resolve() if path else page
        assert linked.exists(), f"{named(page)}: {target}"
        assert not anchor or anchor in anchors(linked), f"{named(page)}: {target}"


def test_every_page_is_reached_from_the_readme() -> None:
    links = {(ROOT / target).resolve() for target in re.findall(r"\]\(([^)#\s]+)", text_of(README))}
    assert set(DOCS.glob("*.md")) <= links


def test_pictures_are_shown_and_small() -> None:
    shown = "".join(text_of(page) for page in PAGES)
    pictures = list((DOCS / "images").iterdir())
    assert pictures
    for picture in pictures:
        assert f"images/{picture.name})" in shown, picture.name
        beginning, most = {".png": (b"\x89PNG", 400_000), ".webp": (b"RIFF", 3_000_000)}[picture.suffix]
        assert picture.read_bytes().startswith(beginning), picture.name
        assert picture.stat().st_size < most, picture.name


@each_block("python")
def test_python_blocks_run(block: Block, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "phframe").symlink_to(ROOT / "phframe")
    try:
        exec(compile(block.text, str(block), "exec", dont_inherit=True), {"__name__": "documentation"})
    except NotInstalledError as error:
        assert marks_of(re.findall(r"\w+", block.text)), block.text
        pytest.skip(str(error))


@pytest.mark.parametrize("block", [b for kind in ("python", "yaml") for b in blocks(kind) if b.source], ids=str)
def test_blocks_from_files_are_the_files(block: Block) -> None:
    assert block.source is not None
    assert block.text == text_of(ROOT / block.source), f"copy {block.source} into {block} again"


def test_the_readme_shows_the_planner_and_the_scene_of_the_examples() -> None:
    sources = {block.source for kind in ("python", "yaml") for block in blocks(kind)}
    assert {"docs/examples/best_next_push.py", "docs/examples/three-cups.yaml"} <= sources


@each_block("yaml")
def test_scene_blocks_are_scenes_that_can_be_solved(block: Block) -> None:
    assert phframe.solve(parse_scene(block.text, str(block))).status is Status.RETRIEVED


def test_what_is_optional_in_a_scene_file_is_shown_with_its_default() -> None:
    (block,) = [block for block in blocks("yaml") if block.page == DOCS / "scenes.md"]
    kept = [line for line in block.text.splitlines() if "# optional" not in line and not line.startswith("  planar:")]
    full, bare = parse_scene(block.text, "full"), parse_scene("\n".join(kept), "bare")
    assert full.base_poses["planar"] == create(Kind.ARM, "planar").default_base_pose(full.shelf)
    assert (full.shelf, full.objects[1:]) == (bare.shelf, bare.objects[1:])
    assert full.objects[0].friction == bare.shelf.board_friction
    assert (full.objects[0].mass, full.objects[0].yaw) == (bare.objects[0].mass, bare.objects[0].yaw)


@each_block("toml")
def test_toml_blocks_announce_a_plugin(block: Block) -> None:
    assert tomllib.loads(block.text)["project"]["entry-points"]["phframe"]


def command_lines() -> Iterator[tuple[str, list[str]]]:
    """Where each command line stands, and its words, without variables set before it."""
    for block in blocks("console"):
        for line in block.text.splitlines():
            if line.startswith("$ "):
                words = shlex.split(line[2:], comments=True)
                while re.match(r"[A-Z_]+=", words[0]):
                    words.pop(0)
                yield f"{block}: {line}", words
    for page in PAGES:
        for text in quoted(page):
            if re.match(r"phframe [a-z-]", text) and "..." not in text and not re.search(r"\b[A-Z]{4}", text):
                yield f"{named(page)}: {text}", [word for word in shlex.split(text) if word not in ("…",)]


LINES = list(command_lines())


@pytest.mark.parametrize(
    "words", [pytest.param(words, marks=marks_of(words)) for _, words in LINES], ids=[where for where, _ in LINES]
)
def test_command_lines_are_understood(words: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    understand = {"phframe": check_phframe, "make": check_make, "python": check_python}
    try:
        understand[words[0]](words[1:])
    except NotInstalledError as error:
        assert marks_of(words), words
        pytest.skip(str(error))


def check_phframe(words: list[str]) -> None:
    """The command and its options exist, and so does all that they name."""
    top: Any = typer.main.get_command(app)
    if words[0].startswith("-"):
        assert words[0] in {spelling for parameter in top.params for spelling in parameter.opts}
        return
    command, rest = leaf(top.commands[words[0]], words[1:])
    with command.make_context(words[0], list(rest)) as context:
        given = dict(context.params)
    if command.name == "run":
        check_bench(given)
    elif words[0] == "solve":
        check_request(given)
    elif words[0] == "export":
        assert given["format_name"] is None or given["format_name"] in FORMATS
        assert given["arm"] is None or load(Kind.ARM, given["arm"])
        assert given["what"].startswith("runs/") or find_scene(given["what"]) is not None
    elif words[0] == "scene":
        assert given["file"].endswith(".xml")
    elif words[0] == "arm":
        assert load(Kind.ARM, given["arm"])
        assert find_scene(given["scene"]) is not None
    elif given.get("name") is not None:
        check_listed(words[0], given)


def check_listed(title: str, given: dict[str, Any]) -> None:
    """What a listing is to describe or show exists."""
    if title == "scenes" and "/" in given["name"]:
        assert find_scene(given["name"], parse_options(given["option"] or ())["scenes"]) is not None
        return
    kind = {"scenes": Kind.SCENES, "topology": Kind.TOPOLOGY}.get(title)
    describe(kind or Kind(title.removesuffix("s")), given["name"])


def leaf(command: Any, rest: list[str]) -> tuple[Any, list[str]]:
    """The command that the words of a group lead to, and the words after it."""
    while hasattr(command, "commands"):
        rest = command.with_default(rest) if hasattr(command, "with_default") else rest
        command, rest = command.commands[rest[0]], rest[1:]
    return command, rest


def check_bench(given: dict[str, Any]) -> None:
    assert select_problems(given["suites"], parse_options(given["option"] or ())["scenes"])
    for planner in given["planner"] or ():
        create(Kind.PLANNER, planner)


def check_request(given: dict[str, Any]) -> None:
    options = parse_options(given["option"] or ())
    find_scene(given["scene"], options["scenes"])
    for kind in (Kind.PLANNER, Kind.BACKEND, Kind.ARM, Kind.TOPOLOGY):
        if given[kind] not in plugin_names():
            load(kind, given[kind]).options_type.parse(options[kind], kind)


def plugin_names() -> set[str]:
    """What the plugins in this repository offer."""
    projects = [tomllib.loads(path.read_text("utf-8")) for path in ROOT.glob("plugins/*/pyproject.toml")]
    return {name for project in projects for name in project["project"]["entry-points"]["phframe"]}


def check_make(words: list[str]) -> None:
    makefile = (ROOT / "Makefile").read_text("utf-8")
    assert re.search(rf"^{words[0]}:.*##", makefile, flags=re.MULTILINE), f"no target {words[0]}"


def check_python(words: list[str]) -> None:
    if words[:2] == ["-m", "phframe.bench.meters"]:
        command_line().parse_args(words[2:])
    else:
        check_pip(words)


def check_pip(words: list[str]) -> None:
    *command, what = words
    assert command == ["-m", "pip", "install"]
    folder, _, extra = what.partition("[")
    assert (ROOT / folder / "pyproject.toml").is_file()
    assert not extra or set(extra.rstrip("]").split(",")) <= extras()


def test_both_commands_of_a_fresh_machine_are_in_the_readme() -> None:
    readme = text_of(README)
    assert all(f"$ {line}" in readme for line in ("make demo", "make test"))
    assert all(part in readme for part in ("`phframe scenes`", "`--json`", "`phframe --install-completion`"))


def test_the_planner_of_the_examples_retrieves_with_fewer_pushes(episode: Episode) -> None:
    ours = phframe.solve("vieira/basic", planner=f"{EXAMPLES / 'best_next_push.py'}:BestNextPush")
    assert ours.status is Status.RETRIEVED
    assert 0 < ours.pushes < episode.pushes


@pytest.mark.parametrize("name", ["plans_are_well_formed", "what_cannot_be_solved_is_a_result", "nothing_is_printed"])
def test_the_planner_of_the_examples_keeps_to_its_interface(name: str) -> None:
    planner = create(Kind.PLANNER, f"{EXAMPLES / 'best_next_push.py'}:BestNextPush")
    (check,) = [check for check in testing.PLANNER_CHECKS if check.name == name]
    check(testing.PlannerUnderTest(planner, testing.simulated_tasks()))


@pytest.mark.slow
def test_the_drawing_of_the_examples_draws(episode: Episode, tmp_path: Path) -> None:
    load_from_file(f"{EXAMPLES / 'draw_decisions.py'}:draw", object)(episode, tmp_path / "decisions.png")
    width, height = (int.from_bytes((tmp_path / "decisions.png").read_bytes()[i : i + 4], "big") for i in (16, 20))
    assert width > 3 * height


def test_the_scene_of_the_examples_is_valid() -> None:
    assert find_scene(EXAMPLES / "three-cups.yaml").name == "three-cups"
