"""What is exported: the results of a bench, and what is true of all of them."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from phframe.bench.environment import Environment
from phframe.bench.settings import BenchSettings
from phframe.bench.trial_result import TrialResult

FORMAT = 1
"""Of what is written: columns may be added, none is removed or changes its meaning or unit."""


@dataclass(frozen=True, slots=True)
class ExportContent:
    """What is exported.

    Attributes:
        results: One by one, gone through once.
        settings: What the bench runs.
        environments: Where trials ran, by the id that results have.
    """

    results: Iterable[TrialResult]
    settings: BenchSettings
    environments: Mapping[str, Environment]

    def header(self) -> dict[str, Any]:
        """All but the results, as JSON has it."""
        environments = {name: json.loads(each.to_json()) for name, each in self.environments.items()}
        return {"format": FORMAT, "settings": json.loads(self.settings.to_json()), "environments": environments}
