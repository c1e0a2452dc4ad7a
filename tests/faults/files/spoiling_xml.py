"""Ways in which an XML file goes wrong: elements gone, doubled, moved, renamed; attributes gone, renamed, changed."""

from __future__ import annotations

import copy
import xml.etree.ElementTree as ET
from collections.abc import Callable, Sequence
from typing import Any

from hypothesis import strategies as st

Draw = Callable[[st.SearchStrategy[Any]], Any]
VALUES = (
    *(
        "nan",
        "inf",
        "-1",
        "0",
        "1",
        "2",
        "1e300",
        "-1e300",
        "1e-300",
        "1e-9",
        "1e9",
        "99999999999999999999",
        "0x10",
        "1_0",
        "٣",
        "1,5",
    ),
    *(
        "",
        " ",
        "x",
        "1 2",
        "0 0 0",
        "1 0 0",
        "0 0 0 0",
        "1 2 3 4 5 6 7",
        "nan nan nan",
        "1e200 1e200 1e200",
        "0.1 0.1 0.1",
        "-1 -1 -1",
    ),
    *(
        "true",
        "false",
        "box",
        "sphere",
        "cylinder",
        "mesh",
        "plane",
        "prismatic",
        "revolute",
        "fixed",
        "continuous",
        "floating",
        "world",
    ),
    *(
        "\u202e",
        "\x85",
        "a" * 101,
        "a" * 5000,
        "é",
        "😀",
        "a/b",
        "../../x",
        "package://x/y.stl",
        "/dev/zero",
        "~",
        "%s",
        "<&>\"'",
    ),
)
"""What is put in the place of an attribute's value."""


@st.composite
def spoilt_xml(draw: Draw, text: str) -> str:
    """An XML text changed at one to three elements or attributes."""
    root = ET.fromstring(text)
    for _ in range(draw(st.sampled_from((1, 1, 1, 2, 3)))):
        elements = list(root.iter())
        draw(st.sampled_from(CHANGES))(draw, root, elements, draw(st.sampled_from(range(len(elements)))))
    return ET.tostring(root, encoding="unicode")


def _value(draw: Draw, _: ET.Element, elements: Sequence[ET.Element], at: int) -> None:
    having = [each for each in elements[at:] if each.attrib] or [each for each in elements if each.attrib]
    if having:
        key = draw(st.sampled_from(sorted(having[0].attrib)))
        having[0].set(key, draw(st.sampled_from(VALUES)))


def _number(draw: Draw, _: ET.Element, elements: Sequence[ET.Element], at: int) -> None:
    """One of the words of a value changed, as in a vector."""
    for element in elements[at:]:
        for key, value in element.attrib.items():
            if words := value.split():
                words[draw(st.integers(0, len(words) - 1))] = draw(st.sampled_from(VALUES))
                element.set(key, " ".join(words))
                return


def _value_of_another(draw: Draw, _: ET.Element, elements: Sequence[ET.Element], at: int) -> None:
    values = [value for each in elements for value in each.attrib.values()]
    if key := next(iter(elements[at].attrib), ""):
        elements[at].set(key, str(draw(st.sampled_from(values))))


def _no_attribute(draw: Draw, _: ET.Element, elements: Sequence[ET.Element], at: int) -> None:
    if elements[at].attrib:
        del elements[at].attrib[draw(st.sampled_from(sorted(elements[at].attrib)))]


def _another_attribute(draw: Draw, _: ET.Element, elements: Sequence[ET.Element], at: int) -> None:
    keys = sorted({key for each in elements for key in each.attrib} | {"name"})
    elements[at].set(draw(st.sampled_from(keys)), draw(st.sampled_from(VALUES)))


def _renamed(draw: Draw, _: ET.Element, elements: Sequence[ET.Element], at: int) -> None:
    elements[at].tag = draw(st.sampled_from(sorted({each.tag for each in elements} | {"x"})))


def _parent(elements: Sequence[ET.Element], at: int) -> ET.Element | None:
    return next((each for each in elements if elements[at] in list(each)), None)


def _gone(_: Draw, __: ET.Element, elements: Sequence[ET.Element], at: int) -> None:
    if (parent := _parent(elements, at)) is not None:
        parent.remove(elements[at])


def _doubled(draw: Draw, _: ET.Element, elements: Sequence[ET.Element], at: int) -> None:
    if (parent := _parent(elements, at)) is not None:
        parent.extend([copy.deepcopy(elements[at]) for _ in range(draw(st.sampled_from((1, 1, 20))))])


def _moved(draw: Draw, root: ET.Element, elements: Sequence[ET.Element], at: int) -> None:
    moved = copy.deepcopy(elements[at])
    if draw(st.booleans()):
        _gone(draw, root, elements, at)
    draw(st.sampled_from(elements)).insert(0, moved)


def _emptied(_: Draw, __: ET.Element, elements: Sequence[ET.Element], at: int) -> None:
    elements[at].clear()


CHANGES = (
    *(_value, _value, _value, _number, _number, _number, _value_of_another, _value_of_another),
    *(_no_attribute, _another_attribute, _renamed, _gone, _gone, _doubled, _moved, _moved, _emptied),
)
