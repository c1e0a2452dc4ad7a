from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from phframe.cli.options import PARTS, parse_options
from phframe.core.errors import InputError, OptionError, UnknownNameError

KEYS = st.from_regex(r"[a-z_]{1,8}", fullmatch=True)
VALUES = st.text(st.characters(codec="ascii", exclude_categories=["C"])).map(str.strip)


def test_a_key_without_a_prefix_is_the_planners() -> None:
    parsed = parse_options(["margin=0.02", "arm.link_width = 0.1", "scenes.count=12"])
    assert parsed == {
        "planner": {"margin": "0.02"},
        "backend": {},
        "arm": {"link_width": "0.1"},
        "plan_backend": {},
        "plan_arm": {},
        "topology": {},
        "goal": {},
        "scenes": {"count": "12"},
    }


@given(st.dictionaries(st.tuples(st.sampled_from(PARTS), KEYS), VALUES))
def test_every_option_comes_back_as_it_was_given(wanted: dict[tuple[str, str], str]) -> None:
    parsed = parse_options(f"{part}.{key}={value}" for (part, key), value in wanted.items())
    assert {(part, key): value for part, values in parsed.items() for key, value in values.items()} == wanted


@given(st.text())
def test_any_text_is_an_option_or_an_input_error(text: str) -> None:
    try:
        parsed = parse_options([text])
    except InputError:
        return
    assert sum(map(len, parsed.values())) == 1


@pytest.mark.parametrize("text", ["", "margin", "=1", "arm.=1", ".margin=1", "  =  "])
def test_malformed(text: str) -> None:
    with pytest.raises(OptionError, match="not of the form key=value"):
        parse_options([text])


def test_unknown_part_and_repeated_key() -> None:
    with pytest.raises(UnknownNameError, match="Did you mean 'topology'"):
        parse_options(["topolgy.x=1"])
    with pytest.raises(OptionError, match=r"planner\.margin is given twice: '1' and '2'"):
        parse_options(["margin=1", "planner.margin=2"])
