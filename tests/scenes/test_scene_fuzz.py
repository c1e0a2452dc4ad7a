"""No text and no bytes make the reader raise anything but phframe's own errors."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from phframe.core import PhframeError, Scene
from phframe.scenes import parse_scene, read_scene
from phframe.yaml.scalars import plain_scalar

PIECES = (
    *(
        "phframe: 1\n",
        "name: a\n",
        "shelf:",
        "objects:",
        "target: a\n",
        "mount: ",
        "id: a",
        "shape: cylinder",
        "radius",
    ),
    *(
        "? ",
        ": ",
        "- ",
        "[",
        "]",
        "{",
        "}",
        ", ",
        "\n",
        "\n  ",
        "\t",
        "#",
        "&a ",
        "*a",
        "!!str ",
        "!<x> ",
        "%YAML 1.2\n",
    ),
    *(
        "---\n",
        "...\n",
        "|\n",
        ">-\n",
        "'",
        '"',
        "\\x41",
        "\\U00110000",
        "\\ud800",
        "~",
        "true",
        ".nan",
        "1e999",
        "0x1",
        "<<",
    ),
    *("\x00", "\x85", "\u2028", "\ufeff", "\ud800", "é", "😀", "9" * 30),
)
GOOD = """\
phframe: 1
name: s01
shelf: {depth: 0.594, width: 0.584, height: 0.4}
target: a
mount: {planar: [0, 0, 0, 0]}
objects:
  - {id: a, shape: cylinder, radius: 0.03, height: 0.12, position: [0.3, 0.3], mass: 1, friction: 0.1, yaw: 1}
"""
WORDS = re.findall(r"\w[\w.]*|\W", GOOD)


def outcome(text: str) -> Scene | str:
    """The scene, or the error's message; anything else is raised."""
    try:
        return parse_scene(text, "fuzz")
    except PhframeError as error:
        return str(error)


@given(st.text() | st.lists(st.sampled_from(PIECES)).map("".join))
@settings(max_examples=150, deadline=None)
def test_no_text_gives_a_traceback(text: str) -> None:
    found = outcome(text)
    assert isinstance(found, str)
    assert found.startswith("fuzz: ")
    assert "\n" not in found


@given(st.integers(0, len(WORDS) - 1), st.sampled_from(PIECES) | st.text(max_size=4), st.booleans())
@settings(max_examples=60, deadline=None)
def test_no_small_change_of_a_good_file_gives_a_traceback(at: int, piece: str, replace: bool) -> None:
    found = outcome("".join([*WORDS[:at], piece, *WORDS[at + replace :]]))
    assert isinstance(found, Scene) or ("\n" not in found and found.startswith("fuzz: "))


@given(st.binary())
@settings(max_examples=60, deadline=None)
def test_no_bytes_give_a_traceback(content: bytes) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.yaml"
        path.write_bytes(content)
        with pytest.raises(PhframeError):
            read_scene(path)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_plain_scalar_is_the_number_python_wrote(number: float) -> None:
    assert plain_scalar(repr(number)) == number


@pytest.mark.parametrize(
    ("text", "value"),
    [
        *(
            ("3e-2", 0.03),
            ("3e2", 300.0),
            ("1.", 1.0),
            (".5", 0.5),
            ("+1", 1),
            ("0123", 123),
            ("0o17", 15),
            ("0xfF", 255),
        ),
        *(("yes", "yes"), ("on", "on"), ("1_000", "1_000"), ("1:30", "1:30"), ("0b1", "0b1"), ("٣", "٣"), ("1e", "1e")),
        *(("", None), ("~", None), ("Null", None), ("True", True), ("FALSE", False), ("inf", "inf"), ("nan", "nan")),
    ],
)
def test_plain_scalars_follow_yaml_1_2(text: str, value: object) -> None:
    found = plain_scalar(text)
    assert (found, type(found)) == (value, type(value))
