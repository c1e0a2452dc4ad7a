"""All trials of a bench, from its settings: everything is looked up before anything runs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from phframe.bench.selection import Problem, select_problems
from phframe.bench.settings import BenchSettings
from phframe.bench.trial import Trial
from phframe.core import OptionError, RunSpec
from phframe.core.run_spec import PARTS
from phframe.core.variant import split_variant
from phframe.registry import Kind, builtins
from phframe.runtime.run import prepare

PLUGINS = "phframe.bench.preload_plugins"
"""The module to preload where trials use what plugins offer."""


@dataclass(frozen=True, slots=True)
class BenchPlan:
    """All trials of a bench.

    Attributes:
        settings: What was asked for, with planners and options as they are stored: registered names, values as values,
            those that are the default left out.
        problems: The problems, in order.
        specs: For every planner and suite, the run that is repeated with each problem and seed.
    """

    settings: BenchSettings
    problems: tuple[Problem, ...]
    specs: Mapping[tuple[str, str], RunSpec]

    @classmethod
    def of(cls, settings: BenchSettings) -> BenchPlan:
        """Look up all that the settings name.

        Raises:
            PhframeError: If a name, an option or a scene cannot be used, or two planners are the same.
        """
        problems = select_problems(settings.suites, settings.options.get("scenes", {}))
        examples = {problem.suite: problem.name for problem in reversed(problems)}
        specs: dict[tuple[str, str], RunSpec] = {}
        for planner in settings.planners:
            ready = {suite: prepare(_asked(settings, planner, problem)).spec for suite, problem in examples.items()}
            name = next(iter(ready.values())).variant_of("planner")
            if any(name == known for known, _ in specs):
                raise OptionError(f"--planner {planner} is the same as one before it, {name}: keep one")
            specs |= {(name, suite): spec for suite, spec in ready.items()}
        return cls(_stored(settings, specs), problems, specs)

    def trials(self) -> Iterator[Trial]:
        """All trials."""
        return (self[number] for number in range(len(self)))

    def __getitem__(self, number: int) -> Trial:
        """One trial: for each seed comes each problem with every planner, so that what is done early can be compared."""
        rest, planner = divmod(number, len(self.settings.planners))
        seed, problem = divmod(rest, len(self.problems))
        if not 0 <= seed < self.settings.seeds:
            raise IndexError(number)
        suite, name = self.problems[problem].suite, self.problems[problem].name
        return Trial(suite, replace(self.specs[self.settings.planners[planner], suite], scene=name, seed=seed))

    def __len__(self) -> int:
        return self.settings.seeds * len(self.problems) * len(self.settings.planners)

    @property
    def modules(self) -> tuple[str, ...]:
        """The modules of phframe's own that its trials use, for their processes to be forked from one that has them."""
        parts = [
            (Kind(part.removeprefix("plan_")), split_variant(name)[0])
            for spec in self.specs.values()
            for part in PARTS
            if isinstance(name := getattr(spec, part), str)
        ]
        entries = [builtins().entry(*part) for part in parts]
        own = dict.fromkeys(each.extension.target.partition(":")[0] for each in entries if each)
        return (*own, *(() if all(entries) else (PLUGINS,)))

    @property
    def digests(self) -> dict[str, str]:
        """A digest of every scene, by its name."""
        return {problem.name: RunSpec(problem.scene).key() for problem in self.problems}


def _asked(settings: BenchSettings, planner: str, problem: str) -> RunSpec:
    """The run that the settings ask for, of one planner on one problem."""
    return RunSpec(
        problem,
        planner,
        settings.backend,
        settings.arm,
        settings.plan_backend,
        settings.plan_arm,
        settings.topology,
        settings.goal,
        _options(settings, planner),
        0,
        settings.loop,
        settings.noise,
    )


def _options(settings: BenchSettings, planner: str) -> dict[str, Mapping[str, object]]:
    """The options of all parts; of the planner those in its brackets count before those for all planners."""
    bracketed = split_variant(planner)[1]
    shared = {key: value for key, value in settings.options.get("planner", {}).items() if key not in bracketed}
    return {**settings.options, "planner": shared}


def _stored(settings: BenchSettings, specs: Mapping[tuple[str, str], RunSpec]) -> BenchSettings:
    """The settings as a store has them."""
    ready = next(iter(specs.values()))
    scenes = next((spec.options["scenes"] for spec in specs.values() if "scenes" in spec.options), {})
    others = {part: given for part, given in ready.options.items() if part not in ("planner", "scenes")}
    return replace(
        settings,
        planners=tuple(dict.fromkeys(planner for planner, _ in specs)),
        backend=ready.backend,
        arm=ready.arm,
        plan_backend=ready.plan_backend,
        plan_arm=ready.plan_arm,
        topology=ready.topology,
        goal=ready.goal,
        options={**others, "scenes": scenes},
    )
