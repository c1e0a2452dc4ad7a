from __future__ import annotations

import signal

import pymunk
import pytest

from phframe.cli.interrupt import dependable_interrupts


def test_an_interrupt_that_an_engine_swallows_is_raised_again() -> None:
    space = _touching()
    calls: list[int] = []

    def interrupted_once(*_: object) -> None:
        calls.append(len(calls))
        if len(calls) == 1:
            signal.raise_signal(signal.SIGINT)

    space.on_collision(post_solve=interrupted_once)
    with pytest.raises(KeyboardInterrupt), dependable_interrupts():  # noqa: PT012 - it may come in any step
        for _ in range(10_000_000):  # many more than there are until it is raised again
            space.step(0.001)
    assert calls


def _touching() -> pymunk.Space:
    space = pymunk.Space()
    space.gravity = (0, -10)
    body = pymunk.Body(1, 1)
    body.position = (0, 1)
    space.add(body, pymunk.Circle(body, 1.0), pymunk.Segment(space.static_body, (-5, 0), (5, 0), 0.1))
    return space
