"""One trial of a bench: a run of one planner on one problem with one seed."""

from __future__ import annotations

from dataclasses import dataclass

from phframe.core import RunSpec, Value


@dataclass(frozen=True, slots=True, eq=False)
class Trial(Value):
    """One run of a bench.

    Attributes:
        suite: The suite it belongs to.
        spec: The run, prepared: registered names, what to plan in, and as options the values that are not the default.
    """

    suite: str
    spec: RunSpec

    @property
    def problem(self) -> str:
        """The scene, as ``suite/name``."""
        return self.spec.scene if isinstance(self.spec.scene, str) else self.spec.scene.name

    @property
    def planner(self) -> str:
        """The planner with its options that are not the default, as in ``phia[sweeps=paper]``."""
        return self.spec.variant_of("planner")

    @property
    def key(self) -> str:
        """Identity: equal trials have equal keys, on every machine and in every process."""
        return self.spec.key()
