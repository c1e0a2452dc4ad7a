"""Random whole numbers that stay the same for ever, on every machine and with every version of numpy."""

from __future__ import annotations

from numpy.random import PCG64, SeedSequence

_BITS = 53


class Draws:
    """Whole numbers from a seed.

    numpy promises the raw stream of PCG64 and of SeedSequence for ever, but not what ``Generator`` makes of it; so
    only the raw stream is used, and whole-number arithmetic from there.

    Args:
        seed: Any whole number from 0.
    """

    def __init__(self, seed: int) -> None:
        self._stream = PCG64(SeedSequence(seed))

    def between(self, low: int, high: int) -> int:
        """A number from ``low`` to ``high``, both included, all equally likely to within 2**-53."""
        raw = int(self._stream.random_raw()) >> (64 - _BITS)
        return low + (raw * (high - low + 1) >> _BITS)
