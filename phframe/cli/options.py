"""``--option key=value``: whose option it is, and which."""

from __future__ import annotations

from collections.abc import Iterable

PARTS = ("planner", "backend", "arm", "plan_backend", "plan_arm", "topology", "goal", "scenes")
"""What has options; a key without a prefix is the planner's."""

EXAMPLES = "margin=0.02 (the planner's), arm.link_width=0.1, scenes.count=12"


def parse_options(given: Iterable[str]) -> dict[str, dict[str, str]]:
    """Options by part and key, as text: what each means is the part's own business.

    Args:
        given: Texts such as ``margin=0.02`` or ``arm.link_width=0.1``.

    Raises:
        OptionError: If one is not of that form, or a key is given twice.
        UnknownNameError: If a prefix is no part.
    """
    parsed: dict[str, dict[str, str]] = {part: {} for part in PARTS}
    for text in given:
        part, key, value = _split(text)
        if key in parsed[part]:
            from phframe.core.errors import OptionError

            raise OptionError(f"--option {part}.{key} is given twice: {parsed[part][key]!r} and {value!r}. Keep one.")
        parsed[part][key] = value
    return parsed


def only_parts(parsed: dict[str, dict[str, str]], *wanted: str) -> dict[str, dict[str, str]]:
    """The options of some parts.

    Raises:
        OptionError: If there are options of others.
    """
    for part, given in parsed.items():
        if given and part not in wanted:
            from phframe.core.errors import OptionError

            key = next(iter(given))
            raise OptionError(
                f"there is no {part} here, so no option {key!r} of it; there are options of {' and '.join(wanted)}."
            )
    return {part: parsed[part] for part in wanted}


def _split(text: str) -> tuple[str, str, str]:
    name, equals, value = (piece.strip() for piece in text.partition("="))
    prefix, dot, key = name.rpartition(".")
    if not equals or not key or (dot and not prefix):
        from phframe.core.errors import OptionError

        raise OptionError(f"--option {text!r} is not of the form key=value or part.key=value, such as {EXAMPLES}.")
    part = prefix if dot else "planner"
    if part not in PARTS:
        from phframe.core.errors import UnknownNameError

        raise UnknownNameError("part with options", part, PARTS, f"Write --option such as {EXAMPLES}.")
    return part, key, value
