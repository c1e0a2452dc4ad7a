"""Names with options in brackets: read as they are written, and bad ones refused in words."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from phframe.core import OptionError
from phframe.core.stored_name import StoredName
from phframe.core.variant import merged_options, split_variant, variant_name

KEYS = st.from_regex(r"[a-z_]{1,8}", fullmatch=True)
VALUES = st.from_regex(r"[a-z0-9.]{1,8}", fullmatch=True) | st.floats(allow_nan=False, allow_infinity=False)


@given(st.dictionaries(KEYS, VALUES, max_size=4))
def test_what_is_written_is_read_again(options: dict[str, str | float]) -> None:
    name, read = split_variant(variant_name("phia", options))
    assert name == "phia"
    assert read.keys() == options.keys()
    for key, value in options.items():
        assert float(read[key]) == value if isinstance(value, float) else read[key] == value


def test_the_order_of_the_options_does_not_matter() -> None:
    assert variant_name("phia", {"sweeps": "paper", "radius": "largest"}) == "phia[radius=largest,sweeps=paper]"
    assert variant_name("phia", {"radius": "largest", "sweeps": "paper"}) == "phia[radius=largest,sweeps=paper]"


def test_a_value_may_hold_commas_in_brackets() -> None:
    assert split_variant("mine[radii=[0.1,0.2],c=1]") == ("mine", {"radii": "[0.1,0.2]", "c": "1"})
    assert variant_name("mine", {"radii": [0.1, 0.2]}) == "mine[radii=[0.1,0.2]]"


def test_a_long_value_is_shortened_and_told_from_others() -> None:
    one, two = (variant_name("guided", {"hints": [{"object": "a", "to": [0.1, y]}] * 9}) for y in (0.2, 0.3))
    assert len(one) < 60
    assert one != two


def test_truth_is_written_as_on_the_command_line() -> None:
    assert variant_name("phia", {"grasp_first": True}) == "phia[grasp_first=true]"


def test_a_plain_name_has_no_options() -> None:
    assert split_variant("./mine.py:Mine") == ("./mine.py:Mine", {})


def test_a_name_from_a_file_stays_one() -> None:
    assert isinstance(split_variant(StoredName("./mine.py:Mine[a=1]"))[0], StoredName)


@pytest.mark.parametrize("text", ["phia[]", "phia[sweeps]", "phia[=paper]", "phia[a=1,a=2]", "phia[a=1,]"])
def test_bad_brackets_are_refused(text: str) -> None:
    with pytest.raises(OptionError, match="write name"):
        split_variant(text)


def test_an_option_in_both_places_is_refused() -> None:
    with pytest.raises(OptionError, match="keep one"):
        merged_options("phia[margin=0.02]", {"margin": 0.01})
