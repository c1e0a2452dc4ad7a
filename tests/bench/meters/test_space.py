"""The figures of the engines in space, and the fit of pymunk to MuJoCo."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import phframe
from phframe.bench.meters import __main__ as bench
from phframe.bench.meters.calibrate import BEFORE, GAIN, GRID, TUNINGS, Observed, Values, fit
from phframe.bench.meters.simulation import Simulation, measure_simulation
from phframe.bench.meters.sweeps import Prediction, Score, compare, outcomes, planned_sweeps, score
from phframe.registry import Kind, load
from phframe.runtime.plan_backend import FITTED as FITTED_ENGINES
from phframe.runtime.plan_backend import PYMUNK_FITTED, default_plan_backend
from phframe.runtime.scenes import scene_names
from tests.markdown import table

SCENES = ("vieira/simple-10", "papallas/s07")
FITTED = {**BEFORE, **PYMUNK_FITTED}


def distance(values: Values, wanted: Values) -> Score:
    """A score that is best where the values are those wanted, and gets worse by a tenth with each that is not."""
    wrong = sum(values[name] != wanted[name] for name in wanted)
    return Score(1, 1, median=0.0, mean=0.0, worst=0.0, fit=0.01 * (1.0 + 0.1 * wrong), same_corridor=1)


@pytest.mark.parametrize("wanted", [{name: grid[-1] for name, grid in GRID.items()}, dict(BEFORE), FITTED])
def test_the_fit_finds_what_fits_best(wanted: Values) -> None:
    assert fit(lambda values: distance(values, wanted), lambda _: None) == wanted


def test_what_hardly_helps_is_left_as_it_is() -> None:
    fits = {0.1: 1.0 - 0.5 * GAIN}
    judge = lambda values: replace(distance(BEFORE, BEFORE), fit=fits.get(values["object_friction"], 1.0))  # noqa: E731
    assert fit(judge, lambda _: None) == BEFORE


def test_a_score_is_of_all_objects_of_all_sweeps() -> None:
    found = score([Prediction("a", (0.001, 0.003), same_corridor=True), Prediction("b", (0.02,), same_corridor=False)])
    assert (found.sweeps, found.objects, found.same_corridor) == (2, 3, 1)
    assert [found.median, found.mean, found.worst] == pytest.approx([0.003, 0.008, 0.02])
    assert found.fit == pytest.approx((2.0 * 4.0 * 21.0) ** (1 / 3) * 1e-3 - 1e-3)


def test_a_backend_predicts_itself_and_an_unlike_one_not() -> None:
    sweeps = planned_sweeps(["vieira/basic"], {})
    assert len(sweeps) == 3
    assert len(planned_sweeps(["vieira/basic"], {}, first=True)) == 1
    truth = outcomes(sweeps, "pymunk")
    observed = Observed(sweeps, truth)
    same, other = observed.score({}), observed.score({"object_friction": 1.0})
    assert (same.worst, same.same_corridor) == (0.0, 3)
    assert other.worst > 1e-3
    assert [prediction.scene for prediction in compare(sweeps, truth, truth)] == ["vieira/basic"] * 3


def test_what_is_shipped_is_documented() -> None:
    rows = {row[0]: row[3] for row in table("docs/fidelity.md", "What is fitted")}
    assert set(rows) == set(GRID)
    for name, value in FITTED.items():
        assert rows[name] == ("none" if value is None else f"{value:.3g}")


@pytest.mark.needs_fast
def test_what_is_shipped_of_the_compiled_engine_is_documented() -> None:
    pytest.importorskip("numba")
    tuning = TUNINGS["fast"]
    options = load(Kind.BACKEND, "fast").options_type().model_dump()
    rows = {row[0]: row[2:] for row in table("docs/fidelity.md", "The compiled engine")}
    assert set(rows) == set(tuning.grid)
    for name, before in tuning.before.items():
        assert options[name] == before
        told = ["none" if value is None else f"{value:.3g}" for value in (before, tuning.shipped[name])]
        assert rows[name] == told


@pytest.mark.needs_mujoco
def test_what_has_nothing_to_fit_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("mujoco")
    with pytest.raises(SystemExit):
        bench.main(["calibrate", "--backend", "mujoco"])
    assert "'mujoco' has nothing to fit to mujoco; these have: pymunk, fast" in capsys.readouterr().err


def test_a_ratio_is_of_the_backend_over_the_bare_loop() -> None:
    assert Simulation("x", "mujoco", simulated=0.3, bare=0.2, steps=10).ratio == pytest.approx(1.5)


@pytest.mark.needs_mujoco
def test_the_bare_loop_takes_the_same_steps_to_the_same_end() -> None:
    pytest.importorskip("mujoco")
    import mujoco

    from phframe.bench.meters import bare_mujoco
    from phframe.core import Settle
    from phframe.runtime.planning_world import PlanningWorld
    from phframe.runtime.world import WorldSpec

    step = mujoco.mj_step
    row = measure_simulation(SCENES[1], "mujoco")
    assert mujoco.mj_step is step, "mujoco is left as it was"
    assert row.steps > 1000
    assert 0.5 < row.ratio < 3.0
    episode = phframe.solve(SCENES[1], backend="mujoco")
    with PlanningWorld(WorldSpec(episode.scene, "mujoco")) as world:
        grasp = episode.steps[-1]
        world.physics.restore(grasp.before)
        tape = bare_mujoco.note(world.physics, lambda: world.physics.execute(grasp.trajectory, settle=Settle()))  # type: ignore[arg-type]
        assert any(tape.changes), "to hold an object, the backend changes what it stands on"
        tape.controls[len(tape.controls) // 2] = tape.controls[0]
        world.physics.restore(grasp.before)
        with pytest.raises(AssertionError, match="ends where the backend did"):
            bare_mujoco.play(world.physics, tape)  # type: ignore[arg-type]


@pytest.mark.needs_mujoco
@pytest.mark.slow
def test_first_sweeps_are_predicted_as_well_as_documented() -> None:
    pytest.importorskip("mujoco")
    names = [name for name in scene_names() if name.startswith(bench.PUBLISHED)]
    sweeps = planned_sweeps(names, PYMUNK_FITTED, first=True)
    found = score(compare(sweeps, outcomes(sweeps, "pymunk", PYMUNK_FITTED), outcomes(sweeps, "mujoco")))
    assert found.sweeps == 31
    assert found.median <= 0.005
    assert found.same_corridor >= 27


@pytest.mark.needs_mujoco
def test_solve_plans_with_what_was_fitted_and_says_so() -> None:
    pytest.importorskip("mujoco")
    plain = phframe.solve(SCENES[0], backend="mujoco")
    fitted = FITTED_ENGINES[default_plan_backend()]
    assert dict(plain.spec.options["plan_backend"]) == fitted
    own = phframe.solve(SCENES[0], backend="mujoco", options={"plan_backend": {"arm_acceleration": 20.0}})
    assert dict(own.spec.options["plan_backend"]) == {**fitted, "arm_acceleration": 20.0}
    assert "plan_backend" not in phframe.solve(SCENES[0]).spec.options


@pytest.mark.needs_mujoco
@pytest.mark.slow
def test_the_fit_leaves_its_figures(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("mujoco")
    monkeypatch.setattr(bench, "scene_names", lambda: SCENES)
    coarse = replace(TUNINGS["pymunk"], grid={"standing_radius": (None, 2 / 3)})
    monkeypatch.setitem(TUNINGS, "pymunk", coarse)
    bench.main(["calibrate", "--scenes", "4", "--out", str(tmp_path / "fit.json")])
    figures = json.loads((tmp_path / "fit.json").read_text())
    assert [judged["sweeps"] for judged in figures["judged"]] == ["fitted to", "held back", "first, published"]
    assert figures["fitted"]["standing_radius"] == pytest.approx(2 / 3)
    for judged in figures["judged"]:
        assert all(np.isfinite(list(judged[key].values())).all() for key in ("before", "fitted", "shipped"))
    printed = capsys.readouterr().out
    assert "pymunk, fitted to MuJoCo" in printed
    assert "Error of the prediction" in printed
