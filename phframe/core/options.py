"""Options: typed, frozen, with units and defaults; anything unknown is an error."""

from __future__ import annotations

from collections.abc import Mapping
from difflib import get_close_matches
from typing import Any, Self

from pydantic import BaseModel, ConfigDict, ValidationError

from phframe.core.errors import OptionError


class Options(BaseModel):
    """Base of every planner's, backend's, arm's and topology engine's options. Fields say their unit."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    @classmethod
    def parse(cls, given: Mapping[str, Any], owner: str) -> Self:
        """Build the options from keys and values, or text.

        Args:
            given: Values, or their text as given on the command line, by name.
            owner: Whose options they are, for the error, such as ``planner phia``.

        Raises:
            OptionError: If a key is unknown (with what exists instead), or a value has the wrong type or range.
        """
        for key in given:
            if key not in cls.model_fields:
                raise OptionError(_unknown(key, owner, sorted(cls.model_fields)))
        try:
            return cls.model_validate(dict(given))
        except ValidationError as error:
            raise OptionError(f"{owner}: " + "; ".join(_sentence(e) for e in error.errors())) from None


def _unknown(key: str, owner: str, known: list[str]) -> str:
    close = get_close_matches(key, known, n=1, cutoff=0.5)
    meant = f" Did you mean {close[0]!r}?" if close else ""
    return f"{owner} has no option {key!r}.{meant} There is: {', '.join(known) or 'none'}."


def _sentence(error: Any) -> str:
    name = str(error["loc"][0]) if error["loc"] else "options"
    return f"option {name!r} is {error['input']!r}: {error['msg'][:1].lower()}{error['msg'][1:]}"
