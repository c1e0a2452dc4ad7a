"""Friction with the board: where what slides stops, and how it turns on the way."""

from __future__ import annotations

import math

import numpy as np
import pytest

from phframe.core import Phase, Settle
from phframe.testing.physics.paths import MIDDLE, OUTSIDE, cylinder, drive_in, path, scene_of
from phframe.testing.physics.stand import on_stand
from tests.backends.fast_.stand import ARM, fast, set_moving, subject

pytestmark = pytest.mark.needs_fast

STANDING = path([[OUTSIDE, 0.5, 0.0], [OUTSIDE, 0.5, 0.0]], [Phase.INSERT], opening=0.0)
GRAVITY = 9.81


def slid(velocity: tuple[float, float, float], friction: float, **options: float) -> np.ndarray:
    """How far an object goes that is let go with a velocity: x, y (m) and yaw (rad)."""
    scene = scene_of(cylinder("o", 0.1, MIDDLE, friction=friction))
    with on_stand(subject(**options), scene) as stand:
        physics = stand.physics
        trajectory = stand.trajectory(stand.start, STANDING)
        before = physics.restore(stand.start)
        set_moving(physics, 0, velocity)
        motion = physics.execute(trajectory, settle=Settle())
        assert motion.settled
        pose = physics.observe().poses[0]
        return np.array([*(pose[:2] - before.poses[0, :2]), 2.0 * math.atan2(pose[6], pose[3])])


@pytest.mark.parametrize("friction", [0.05, 0.25, 0.6])
@pytest.mark.parametrize("speed", [0.05, 0.2, 0.7])
def test_it_stops_after_the_square_of_its_speed_over_twice_the_friction(speed: float, friction: float) -> None:
    way = speed**2 / (2.0 * friction * GRAVITY)
    if way < 0.4:
        assert slid((speed, 0.0, 0.0), friction)[0] == pytest.approx(way, rel=1e-9)


def test_a_turn_on_the_spot_stops_as_an_evenly_pressing_disc_does() -> None:
    """Torque 2/3 mu m g R against the inertia m R^2 / 2: w^2 R / (8/3 mu g)."""
    spin, friction = 10.0, 0.25
    assert slid((0.0, 0.0, spin), friction)[2] == pytest.approx(
        spin**2 * 0.03 / (8.0 / 3.0 * friction * GRAVITY), rel=0.02
    )


def test_what_slides_is_hardly_kept_from_turning() -> None:
    fast_slide, spinning = slid((0.5, 0.0, 2.0), 0.25), slid((0.0, 0.0, 2.0), 0.25)
    assert fast_slide[2] > 3.0 * spinning[2]


def test_what_touches_nothing_does_not_depend_on_the_length_of_steps() -> None:
    ends = [slid((0.3, 0.1, 0.0), 0.25, step=step) for step in (0.001, 0.004)]
    assert ends[0] == pytest.approx(ends[1], abs=1e-9)


def test_a_push_leaves_an_object_with_the_speed_of_the_arm() -> None:
    """No momentum is made: what is let go at 0.3 m/s coasts as far as that takes it, at the most."""
    with on_stand(subject(arm_acceleration=None), scene_of(cylinder("o", 0.12, MIDDLE, friction=0.2))) as stand:
        state = stand.run(stand.start, drive_in(0.25, speed=0.3)).state
        coasted = stand.center(state, "o")[0] - 0.25 - 0.03
        assert coasted == pytest.approx(0.3**2 / (2.0 * 0.2 * GRAVITY), rel=0.03)


def test_options_out_of_range_are_told() -> None:
    from phframe.core import OptionError

    backend = type(fast(scene_of(cylinder("o", 0.1, MIDDLE))))
    for given in ({"step": "0"}, {"iterations": "1000"}, {"gravity": "3"}):
        with pytest.raises(OptionError, match="backend fast"):
            backend.options_type.parse(given, "backend fast")
    assert ARM.shape.min_opening == 0.0
