"""What the tests of recorders record."""

from __future__ import annotations

import pytest

from tests.recorders.synthetic_episode import Recorded, hand_made


@pytest.fixture(scope="module")
def made() -> Recorded:
    """An episode made by hand."""
    return hand_made()
