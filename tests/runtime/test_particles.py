"""Samples of the world are worlds that can be: as far off as was declared, their friction their own for all of an episode."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from phframe.core import Particle, Plan, RunSpec, SearchTree, Status, Task
from phframe.planners.phia import PHIA, PHIAOptions
from phframe.runtime.noise import Noise
from phframe.runtime.particles import Particles
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.run import run
from phframe.runtime.scenes import find_scene, scene_names
from phframe.runtime.solve import solve
from phframe.runtime.world import WorldSpec
from tests.pushing.worlds import task_in
from tests.runtime.test_sensor import SHAPE, as_seen
from tests.runtime.worlds import BASIC

BOTH = Noise(position=0.005, friction=0.3)
PUBLISHED = [name for name in scene_names() if name.startswith(("vieira", "papallas"))]


def drawn(noise: Noise, number: int, *, times: int = 1, seed: int = 0) -> list[list[Particle]]:
    with Particles(WorldSpec(BASIC), noise, SHAPE, seed) as particles:
        return [particles.draw(BASIC.initial_state(), number) for _ in range(times)]


@settings(max_examples=10, deadline=None)
@given(st.sampled_from(PUBLISHED), st.sampled_from([0.001, 0.005, 0.03]), st.integers(0, 100))
def test_every_sample_could_be_a_scene(name: str, position: float, seed: int) -> None:
    scene = find_scene(name)
    with Particles(WorldSpec(scene), Noise(position=position), SHAPE, seed) as particles:
        for particle in particles.draw(scene.initial_state(), 3):
            assert as_seen(scene, particle.start) == []
            assert (particle.start.positions != scene.initial_state().positions).any()
            assert particle.start.conditions == scene.initial_state().conditions


def test_they_differ_from_one_another_and_from_draw_to_draw() -> None:
    first, again = drawn(BOTH, 4, times=2)
    starts = [particle.start.poses.tobytes() for particle in (*first, *again)]
    assert len(set(starts)) == 8


def test_the_same_seed_gives_the_same_samples_and_another_seed_others() -> None:
    one, two, other = (drawn(BOTH, 3, times=2, seed=seed)[1] for seed in (1, 1, 2))
    assert [particle.start for particle in one] == [particle.start for particle in two]
    assert all(a.start != b.start for a, b in zip(one, other, strict=True))


def test_the_first_of_many_are_the_same_as_of_few() -> None:
    few, many = drawn(BOTH, 2)[0], drawn(BOTH, 5)[0]
    assert [particle.start for particle in few] == [particle.start for particle in many[:2]]


def test_each_keeps_its_friction_and_no_two_have_the_same() -> None:
    """The same action from the same state comes to the same in a sample whenever it is drawn, and to other things in others."""
    state = BASIC.initial_state()
    with PlanningWorld(WorldSpec(BASIC)) as world, Particles(WorldSpec(BASIC), BOTH, SHAPE, 0) as particles:
        action = PHIA(PHIAOptions()).plan(task_in(world)).actions[0]
        draws = [particles.draw(state, number) for number in (3, 3, 4)]
        made = [[particle.apply(state, action, None) for particle in draw] for draw in draws]
        assert made[0] == made[1] == made[2][:3]
        ends = {each.state.poses.tobytes() for each in made[2]} | {world.apply(state, action).state.poses.tobytes()}
        assert len(ends) == 5


def test_without_noise_of_friction_they_have_the_believed_one() -> None:
    state = BASIC.initial_state()
    with PlanningWorld(WorldSpec(BASIC)) as world:
        action = PHIA(PHIAOptions()).plan(task_in(world)).actions[0]
        with Particles(WorldSpec(BASIC), Noise(position=0.005), SHAPE, 0) as particles:
            [particle] = particles.draw(state, 1)
            assert particle.apply(state, action, None) == world.apply(state, action)
            assert particle.start != state
        with Particles(WorldSpec(BASIC), Noise(friction=0.3), SHAPE, 0) as particles:
            [particle] = particles.draw(state, 1)
            assert particle.start == state
            assert particle.apply(state, action, None) != world.apply(state, action)


class Sampling(PHIA):
    """Notes the samples that it is given."""

    def __init__(self) -> None:
        super().__init__(PHIAOptions())
        self.samples: list[tuple[Particle, ...]] = []

    def search(self, task: Task) -> Plan:
        self.samples.append(task.particles(5))
        return SearchTree(task.start).plan(0, Status.FAILED, "it only asks")


@pytest.mark.parametrize(
    ("noise", "number"),
    [(None, 0), ({"position": 0.0, "friction": 0.0}, 0), ({"position": 0.002}, 5), ({"friction": 0.1}, 5)],
)
def test_a_run_has_samples_where_noise_is_declared(noise: dict[str, Any] | None, number: int) -> None:
    planner = Sampling()
    run(RunSpec(scene="vieira/basic", planner=planner, noise=noise or {}))
    assert [len(samples) for samples in planner.samples] == [number]


class Drawing(PHIA):
    """Draws samples, and plans as if it had not."""

    def search(self, task: Task) -> Plan:
        assert len(task.particles(3)) == 3
        return super().search(task)


def test_who_draws_sees_the_same_world_as_who_does_not() -> None:
    """Samples come from a stream of random numbers of their own."""
    noise = {"position": 0.005, "friction": 0.3}
    drawing, plain = (
        run(RunSpec(scene="vieira/basic", planner=planner, noise=noise))
        for planner in (Drawing(PHIAOptions()), PHIA(PHIAOptions()))
    )
    assert drawing.plans == plain.plans
    assert drawing.steps == plain.steps
    assert plain.steps


def test_sure_says_in_how_many_of_them_its_plan_is_clean() -> None:
    for number in (0, 3):
        episode = solve(
            "vieira/basic", planner="sure", noise=BOTH.model_dump(), options={"planner": {"particles": number}}
        )
        for plan in episode.plans:
            assert plan.certainty is not None
            assert plan.certainty.samples == number
            assert 0 <= plan.certainty.clean <= number


def test_sure_plans_the_same_in_the_same_samples() -> None:
    options = {"planner": {"particles": 2}}
    one, two = (solve("vieira/basic", planner="sure", noise=BOTH.model_dump(), options=options) for _ in range(2))
    assert one == two
    assert one.plans
