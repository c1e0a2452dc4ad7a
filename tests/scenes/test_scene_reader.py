"""Scene files: what a good one gives, and the one clear line for every bad one."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from phframe.core import BasePose, Cylinder, InputError, SceneError, SceneObject, Shelf
from phframe.scenes import parse_scene, read_scene
from phframe.yaml.file import MAX_BYTES
from phframe.yaml.tree import MAX_DEPTH

GOOD = """\
phframe: 1
name: s01
shelf: {depth: 0.594, width: 0.584, height: 0.4}
target: object_3
objects:
  - {id: object_1, shape: cylinder, radius: 0.03, height: 0.12, position: [0.37975, 0.31175]}
  - {id: object_3, shape: cylinder, radius: 0.03, height: 0.12, position: [0.56208, 0.48682]}
"""
FULL = """\
phframe: 1
name: "all of it"
shelf: {depth: 1, width: 6e-1, height: 0.4, wall_friction: 0, board_friction: 3e-1}
mount: {planar: [-0.5, 0.3, 0, 1.5], "my arm": [0, 0, 0, 0]}
target: mug
objects:
- id: mug
  shape: cylinder
  radius: 0.04
  height: 0.1
  position: [0.5, 0.3]
  mass: 2
  friction: 0.4
  yaw: -1.5
- {id: "7", shape: cylinder, radius: 0.03, height: 0.12, position: [0.1, 0.1], friction: ~}
"""


def test_the_published_format_is_read_with_its_defaults() -> None:
    scene = parse_scene(GOOD)
    assert (scene.name, scene.target, scene.ids) == ("s01", "object_3", ("object_1", "object_3"))
    assert scene.shelf == Shelf(0.594, 0.584, 0.4, board_friction=0.25, wall_friction=0.2)
    expected = SceneObject("object_1", Cylinder(0.03, 0.12), (0.37975, 0.31175), yaw=0.0, mass=0.3, friction=None)
    assert scene.objects[0] == expected
    assert scene.base_poses == {}


def test_everything_optional_is_read() -> None:
    scene = parse_scene(FULL)
    assert scene.shelf == Shelf(1.0, 0.6, 0.4, board_friction=0.3, wall_friction=0.0)
    assert scene.objects[0] == SceneObject("mug", Cylinder(0.04, 0.1), (0.5, 0.3), -1.5, 2.0, 0.4)
    assert scene.objects[1].id == "7"
    assert scene.objects[1].friction is None
    assert scene.base_poses == {"planar": BasePose(-0.5, 0.3, 0.0, 1.5), "my arm": BasePose(0.0, 0.0, 0.0, 0.0)}
    assert type(scene.shelf.depth) is float


def test_a_file_is_read_with_or_without_a_byte_order_mark(tmp_path: Path) -> None:
    plain, marked = tmp_path / "plain.yaml", tmp_path / "marked.yaml"
    plain.write_bytes(GOOD.encode())
    marked.write_bytes(b"\xef\xbb\xbf" + GOOD.replace("\n", "\r\n").encode())
    assert read_scene(plain) == read_scene(str(marked)) == parse_scene(GOOD)


def changed(old: str, new: str) -> str:
    """The good scene with one thing changed."""
    assert old in GOOD
    return GOOD.replace(old, new, 1)


BAD: dict[str, tuple[str, list[str]]] = {
    "empty": ("", ["empty", "phframe: 1"]),
    "only a comment": ("# nothing\n", ["empty"]),
    "a list": ("- 1\n- 2\n", ["a list of 2", "expected a mapping"]),
    "a text": ("hello", ["'hello'", "expected a mapping"]),
    "no format": (changed("phframe: 1\n", ""), ["line 1: phframe is missing", "format"]),
    "newer format": (
        "phframe: 2\nnew: {}\n",
        ["line 1: this file is format 2; this phframe reads format 1: upgrade phframe"],
    ),
    "format true": (changed("phframe: 1", "phframe: true"), ["line 1: phframe is true"]),
    "format 0": (changed("phframe: 1", "phframe: 0"), ["line 1: phframe is 0"]),
    "format as text": (changed("phframe: 1", "phframe: '1'"), ["line 1: phframe is '1'"]),
    "format as float": (changed("phframe: 1", "phframe: 1.0"), ["line 1: phframe is 1.0"]),
    "unknown key": (GOOD + "colour: red\n", ["line 8: unknown key 'colour'; known: phframe, name, shelf"]),
    "misspelt key": (
        changed("radius: 0.03", "raduis: 0.03"),
        ["line 6: unknown key 'raduis' in objects[0] (did you mean 'radius'?)", "objects[0].radius is missing"],
    ),
    "misspelt shelf key": (changed("depth", "dept"), ["line 3: unknown key 'dept' in shelf (did you mean 'depth'?)"]),
    "duplicate key": (GOOD + "name: other\n", ["line 8: the key 'name' is given twice (first in line 2)"]),
    "duplicate key inside": (changed("radius: 0.03", "id: x"), ["line 6: the key 'id' is given twice"]),
    "missing key": (changed("target: object_3\n", ""), ["target is missing: the id of the object to take out"]),
    "missing position": (changed(", position: [0.37975, 0.31175]", ""), ["line 6: objects[0].position is missing"]),
    "missing shape": (changed("shape: cylinder, ", ""), ["line 6: objects[0].shape is missing"]),
    "unknown shape": (changed("cylinder", "box"), ["line 6: objects[0].shape is 'box'; expected one of: 'cylinder'"]),
    "shape that is a list": (changed("cylinder", "[1]"), ["line 6: objects[0].shape is a list of 1"]),
    "number as text": (changed("0.03", "'0.03'"), ["line 6: objects[0].radius is the text '0.03'; expected a number"]),
    "comma as point": (changed("radius: 0.03", "radius: 0;03"), ["objects[0].radius is the text '0;03'"]),
    "boolean as number": (changed("0.03", "true"), ["line 6: objects[0].radius is true; expected a number"]),
    "yes is text": (changed("0.03", "yes"), ["objects[0].radius is the text 'yes'; expected a number"]),
    "nothing": (changed("0.03", ""), ["objects[0].radius is empty; expected a number"]),
    "number as id": (changed("object_1", "7"), ["line 6: objects[0].id is 7; expected text"]),
    "empty id": (changed("object_1", "''"), ["objects[0].id is ''; expected text that is not empty"]),
    "id with a line break": (changed("object_1", '"a\\nb"'), ["objects[0].id is 'a\\nb'; expected printable text"]),
    "long id": (changed("object_1", "x" * 101), ["objects[0].id", "at most 100 characters"]),
    "not a number": (changed("0.37975", ".nan"), ["line 6: objects[0].position[0] is nan; expected a finite number"]),
    "infinite": (changed("0.594", ".inf"), ["line 3: shelf.depth is inf; expected a finite number"]),
    "infinite by digits": (changed("0.594", "9" * 400), ["line 3: shelf.depth is inf; expected a finite number"]),
    "negative": (changed("0.03", "-0.03"), ["line 6: objects[0].radius is -0.03; expected a number above 0"]),
    "zero": (changed("0.4", "0"), ["line 3: shelf.height is 0; expected a number above 0"]),
    "negative friction": (
        changed("height: 0.4", "height: 0.4, wall_friction: -1"),
        ["shelf.wall_friction is -1; expected a number of 0 or more"],
    ),
    "one coordinate": (changed("[0.37975, 0.31175]", "[0.3]"), ["is a list of 1; expected 2 numbers [x, y]"]),
    "position no list": (changed("[0.37975, 0.31175]", "{x: 1}"), ["is a mapping; expected a list of numbers"]),
    "mount too short": (
        GOOD + "mount: {a: [0, 1]}\n",
        ["line 8: mount.a is a list", "4 numbers [x, y, z, yaw]"],
    ),
    "mount no mapping": (GOOD + "mount: [0]\n", ["line 8: mount is a list of 1; expected a mapping"]),
    "shelf no mapping": (changed("{depth: 0.594, width: 0.584, height: 0.4}", "3"), ["line 3: shelf is 3"]),
    "objects no list": (GOOD.partition("  -")[0] + "  a: 1\n", ["objects is a mapping; expected a list"]),
    "no objects": (
        GOOD.partition("objects")[0] + "objects: []\n",
        ["objects is a list of 0; expected at least one object"],
    ),
    "object no mapping": (GOOD + "  - 3\n", ["line 8: objects[2] is 3; expected a mapping"]),
    "duplicate ids": (changed("object_1", "object_3"), ["the id 'object_3' is used 2 times"]),
    "no such target": (changed("target: object_3", "target: o"), ["the target 'o' is not among", "object_1, object_3"]),
    "overlap": (
        changed("[0.37975, 0.31175]", "[0.56208, 0.43682]"),
        ["'object_1'", "'object_3'", "overlap by 10.0 mm"],
    ),
    "in the wall": (changed("0.31175", "0.02404"), ["object 'object_1' is 6.0 mm inside the south wall"]),
    "before the mouth": (changed("0.37975", "-0.01"), ["object 'object_1' is 10.0 mm outside the mouth"]),
    "alias": ("a: &x 1\nb: *x\n", ["line 1: YAML anchors (&x)", "line 2: YAML aliases (*x)"]),
    "tag": (changed("0.03", "!!float 0.03"), ["line 6: YAML tags", "not allowed"]),
    "python tag": ("!!python/object/apply:os.getcwd []", ["YAML tags", "not allowed"]),
    "old YAML": ("%YAML 1.1\n---\n" + GOOD, ["directives (%) are not allowed"]),
    "two documents": (GOOD + "---\n" + GOOD, ["line 8: a second document begins"]),
    "key that is a list": ("[1]: 2\n", ["line 1: a key is a list, mapping or alias"]),
    "key that is a mapping": (changed("{depth", "{{depth"), ["line 3: a key is a list, mapping or alias"]),
    "not YAML": (changed("{depth", "{depth: {"), ["line 4", "not valid YAML"]),
    "unclosed": ("a: [1,", ["line 1", "not valid YAML"]),
    "control character": ("a: \x01", ["line 1: the character '\\x01' is not allowed"]),
    "deep": ("[" * 1000 + "]" * 1000, [f"nested more than {MAX_DEPTH} levels deep"]),
    "deep blocks": ("- " * 1000, [f"nested more than {MAX_DEPTH} levels deep"]),
    "deep keys": ("? " * 1000, ["line 1: a key is a list, mapping or alias"]),
    "half a character in a key": (
        GOOD + 'mount: {"\\ud800": [0, 0, 0, 0]}\n',
        ["line 8: '\\ud800' holds half of a character"],
    ),
    "half a character": (changed("object_1", '"\\udfff"'), ["line 6: '\\udfff' holds half of a character"]),
    "too heavy": (changed("radius: 0.03", "radius: 0.03, mass: 1e20"), ["mass is 1e+20 kg; the most is 1000 kg"]),
    "too large": ("#" * (MAX_BYTES + 1), ["larger than 1 MB"]),
}


@pytest.mark.parametrize(("text", "fragments"), BAD.values(), ids=BAD)
def test_bad_input_is_one_clear_line(text: str, fragments: list[str]) -> None:
    with pytest.raises(SceneError) as caught:
        parse_scene(text, "shelf.yaml")
    message = str(caught.value)
    assert message.startswith("shelf.yaml: ")
    assert message.isprintable()
    for fragment in fragments:
        assert fragment in message


def test_several_problems_are_listed_in_the_order_of_the_file() -> None:
    text = GOOD.replace("0.594", "-1").replace("radius: 0.03", "radius: x").replace("name: s01", "name: 3")
    with pytest.raises(SceneError) as caught:
        parse_scene(text)
    assert [problem.split(" is ")[0] for problem in caught.value.problems] == [
        "line 2: name",
        "line 3: shelf.depth",
        "line 6: objects[0].radius",
        "line 7: objects[1].radius",
    ]


def test_a_flood_of_problems_is_cut_and_counted() -> None:
    item = "  - {id: a, shape: cylinder, radius: x, height: 0.12, position: [0.3, 0.3]}\n"
    with pytest.raises(SceneError) as caught:
        parse_scene(GOOD.partition("  -")[0] + item * 25)
    assert len(caught.value.problems) == 11
    assert caught.value.problems[-1] == "and 15 more"


def test_a_path_that_cannot_be_read_is_one_clear_line(tmp_path: Path) -> None:
    paths: list[tuple[str | Path, str]] = [
        (tmp_path / "none.yaml", "no such file"),
        (tmp_path, "is a directory"),
        (tmp_path / "none" / "a.yaml", "no such file"),
        (tmp_path / ("x" * 300), "name too long"),
    ]
    for path, reason in paths:
        with pytest.raises(InputError, match=f"cannot read the scene file .*{reason}") as caught:
            read_scene(path)
        assert str(caught.value).isprintable()


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="the superuser may read everything")
def test_a_file_without_permission_is_one_clear_line(tmp_path: Path) -> None:
    path = tmp_path / "secret.yaml"
    path.write_text(GOOD)
    path.chmod(0)
    with pytest.raises(InputError, match="permission denied"):
        read_scene(path)


@pytest.mark.parametrize(
    ("content", "fragment"),
    [
        (b"name: a\nb: \xff\xfe", r"line 2: not UTF-8 text \(byte 0xff\)"),
        (bytes(range(256)), "not UTF-8 text"),
        ("name: a".encode("utf-16"), "not UTF-8 text"),
        (b"\0\0\0", "character .* is not allowed"),
        (b"", "empty"),
        (b"#" * (MAX_BYTES + 1), "larger than 1 MB"),
    ],
    ids=["byte", "binary", "utf-16", "zeros", "empty", "large"],
)
def test_a_file_that_is_no_text_is_one_clear_line(tmp_path: Path, content: bytes, fragment: str) -> None:
    path = tmp_path / "scene.yaml"
    path.write_bytes(content)
    with pytest.raises(SceneError, match=fragment):
        read_scene(path)
