"""Hints files are read, and what is wrong with one is told with its line."""

from __future__ import annotations

from pathlib import Path

import pytest

from phframe.core import DocumentError, InputError
from phframe.pushing.hints import HintOption, read_hints

GOOD = """# in order
- object: object_3
  to: [0.2, 5e-1]
- {object: "4", to: [1, 2]}
"""


def written(folder: Path, text: str | bytes) -> Path:
    path = folder / "hints.yaml"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return path


def test_hints_are_read_in_order_with_where_they_are(tmp_path: Path) -> None:
    path = written(tmp_path, GOOD)
    assert read_hints(path) == [
        {"object": "object_3", "to": [0.2, 0.5], "where": f"{path}: line 2"},
        {"object": "4", "to": [1, 2], "where": f"{path}: line 4"},
    ]
    assert read_hints(written(tmp_path, "[]")) == []


def test_where_a_hint_was_written_is_not_stored() -> None:
    assert HintOption(object="a", to=(0.1, 0.2), where="x.yaml: line 2").model_dump() == {
        "object": "a",
        "to": (0.1, 0.2),
    }


BAD: dict[str, tuple[str, list[str]]] = {
    "no list": ("object: a\n", ["holds a mapping; expected a list of hints such as"]),
    "empty": ("", ["the file holds empty; expected a list"]),
    "no hint": ("- 3\n", ["line 1: a hint is 3; expected"]),
    "unknown key": ("- {object: a, to: [1, 2], at: 3}\n", ["line 1: unknown key 'at'", "known: object, to"]),
    "meant": ("- {objects: a, to: [1, 2]}\n", ["did you mean 'object'?", "lacks object"]),
    "no place": ("\n- object: a\n", ["line 2: a hint lacks to: where it is to stand, [x, y] (m)"]),
    "three figures": ("- object: a\n  to: [1, 2, 3]\n", ["line 2: to is a list of 3"]),
    "text": ("- {object: a, to: [1, b]}\n", ["line 1: to is"]),
    "truth": ("- {object: a, to: [1, true]}\n", ["line 1: to is"]),
    "not finite": ("- {object: a, to: [1, .nan]}\n", ["line 1: to is"]),
    "number for a name": (
        "- {object: 3, to: [1, 2]}\n",
        ["line 1: object is 3; expected the id of an object, as text"],
    ),
    "twice": ("- {object: a, object: b, to: [1, 2]}\n", ["line 1: the key 'object' is given twice"]),
    "not YAML": ("- {object: a\n", ["line 2", "not valid YAML"]),
    "alias": ("- &a {object: a, to: [1, 2]}\n- *a\n", ["line 1: YAML anchors", "line 2: YAML aliases"]),
    "all of it": ("- 1\n" * 12, ["line 10: ", "and 2 more"]),
}


@pytest.mark.parametrize("case", BAD)
def test_what_is_wrong_is_told_with_its_line(tmp_path: Path, case: str) -> None:
    text, parts = BAD[case]
    path = written(tmp_path, text)
    with pytest.raises(DocumentError) as caught:
        read_hints(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert [part for part in parts if part not in str(caught.value)] == []


def test_files_that_cannot_be_read_are_told(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"cannot read the hints file .*nowhere\.yaml: no such file"):
        read_hints(tmp_path / "nowhere.yaml")
    with pytest.raises(InputError, match=r"cannot read the hints file .*directory"):
        read_hints(tmp_path)
    with pytest.raises(DocumentError, match=r"line 2: not UTF-8 text \(byte 0xff\)"):
        read_hints(written(tmp_path, b"\n\xff"))
    with pytest.raises(DocumentError, match="larger than 1 MB; that is no hints file"):
        read_hints(written(tmp_path, "#" * 1_000_001))
    with pytest.raises(InputError, match="is not a path"):
        read_hints("")
