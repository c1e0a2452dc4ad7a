"""Comparisons that yield a fault where two things differ."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from phframe.core import PhframeError, State
from phframe.testing.check import Fault, Faults


def expect(holds: object, expected: str, found: str) -> Faults:
    """A fault unless something holds."""
    if not holds:
        yield Fault(expected, found)


def expect_equal(found: object, expected: object, what: str) -> Faults:
    """A fault unless two values are equal, arrays bit by bit."""
    yield from expect(found == expected, f"{what}: {_short(expected)}", _difference(found, expected))


def expect_close(found: ArrayLike, expected: ArrayLike, tolerance: float, what: str) -> Faults:
    """A fault unless all numbers are within a tolerance of what they should be."""
    a, b = np.asarray(found, dtype=np.float64), np.asarray(expected, dtype=np.float64)
    if a.shape != b.shape:
        yield Fault(f"{what}: shape {b.shape}", f"shape {a.shape}")
        return
    gap = float(np.abs(a - b).max(initial=0.0))
    yield from expect(gap <= tolerance, f"{what}: {_short(b)} within {tolerance:g}", f"{_short(a)}, off by {gap:.3g}")


def expect_at_most(found: float, limit: float, what: str) -> Faults:
    """A fault unless a number is at most a limit (not a number is not)."""
    yield from expect(found <= limit, f"{what}: at most {limit:.6g}", f"{found:.6g}")


def expect_raises(kind: type[PhframeError], call: Callable[[], object], what: str) -> Faults:
    """A fault unless a call raises an error of a kind."""
    try:
        result = call()
    except kind:
        return
    except Exception as error:  # noqa: BLE001 - the wrong kind is the finding
        yield Fault(f"{kind.__name__} for {what}", f"{type(error).__name__}: {error}")
        return
    yield Fault(f"{kind.__name__} for {what}", f"it returned {_short(result)}")


def _difference(found: object, expected: object) -> str:
    if isinstance(found, State) and isinstance(expected, State) and found.poses.shape == expected.poses.shape:
        gap = float(np.abs(found.poses - expected.poses).max(initial=0.0))
        if gap:
            return f"poses that differ by up to {gap:.3g}"
    return _short(found)


def _short(value: object) -> str:
    text = " ".join(repr(value).split())
    return text if len(text) <= 300 else f"{text[:300]}..."
