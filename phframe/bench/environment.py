"""Where trials ran: versions, code, machine."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import ClassVar

from pydantic import ConfigDict, TypeAdapter, ValidationError

from phframe.core import InputError, Value
from phframe.core.run_spec import first_fault
from phframe.core.stored_json import parse_json

_ID_LENGTH = 16


@dataclass(frozen=True, slots=True, eq=False)
class Environment(Value):
    """What a trial's figures may depend on beside its spec. Names of machines and users are left out.

    Attributes:
        versions: Of Python, phframe, the plugins used, and the libraries behind them.
        commit: Of phframe's source tree, with ``+`` where it holds changes; empty where it is none.
        code: Digests of the code that is no part of a version, by name: of phframe's source and of planners in files.
        system: Operating system and its kernel's version.
        cpu: The processor's name.
        cores: How many it has for us.
        memory: Of the machine (MB); 0: not known.
    """

    __pydantic_config__: ClassVar = ConfigDict(extra="forbid")

    versions: Mapping[str, str] = field(default_factory=dict)
    commit: str = ""
    code: Mapping[str, str] = field(default_factory=dict)
    system: str = ""
    cpu: str = ""
    cores: int = 0
    memory: int = 0

    @property
    def id(self) -> str:
        """The same for the same content."""
        return hashlib.sha256(self.to_json().encode()).hexdigest()[:_ID_LENGTH]

    def to_json(self) -> str:
        """The environment as JSON."""
        return json.dumps(asdict(self), sort_keys=True)

    @staticmethod
    def from_json(text: str) -> Environment:
        """An environment from JSON.

        Raises:
            InputError: If it is none.
        """
        try:
            return _ENVIRONMENT.validate_python(parse_json(text))
        except ValidationError as error:
            raise InputError(f"this is no environment of a bench: {first_fault(error)}") from None
        except (ValueError, TypeError, RecursionError) as error:
            raise InputError(f"this is no environment of a bench: {error}") from None


_ENVIRONMENT = TypeAdapter(Environment)
