"""``phframe.core`` loads what it names when it is first used."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import phframe.core
from phframe.core import everything

ROOT = Path(__file__).parents[2]
HEAVY = ("numpy", "pydantic", "pluggy", "scipy")


def test_all_that_it_names_is_there() -> None:
    assert all(getattr(phframe.core, name) is getattr(everything, name) for name in everything.__all__)
    assert phframe.core.__all__ == everything.__all__
    with pytest.raises(AttributeError, match=r"module 'phframe\.core' has no attribute 'Nothing'"):
        getattr(phframe.core, "Nothing")  # noqa: B009 - that it names, a type checker would say


def test_no_module_has_the_name_of_a_thing() -> None:
    """Else importing the module would put it in the place of the thing."""
    modules = {path.stem for path in (ROOT / "phframe" / "core").glob("*.py")}
    assert modules.isdisjoint(everything.__all__)


def test_the_errors_load_nothing_heavy() -> None:
    program = f"import sys, phframe.core.errors; print([name for name in {HEAVY} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
