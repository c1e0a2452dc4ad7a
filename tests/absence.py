"""Makes libraries that are installed look as if they were not."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from importlib import import_module, metadata
from importlib.machinery import ModuleSpec
from typing import Any

DISTRIBUTIONS = {
    "mujoco": "mujoco",
    "pybullet": "pybullet",
    "ompl": "ompl",
    "pinocchio": "pin",
    "coal": "coal",
    "toppra": "toppra",
    "av": "av",
    "trimesh": "trimesh",
}
"""Of the libraries for 3D, by the module that they are imported as."""
OPTIONAL = {**DISTRIBUTIONS, "numba": "numba"}
"""The same of all libraries that can be hidden."""


class Without:
    """A finder of modules and distributions that does not find some of them.

    Args:
        finder: That finds them all.
        modules: What it is not to find; with the distributions that these come in.
    """

    def __init__(self, finder: Any, modules: Sequence[str]) -> None:
        self._finder, self._modules = finder, frozenset(modules)
        self._distributions = frozenset(OPTIONAL[module] for module in modules)

    def find_spec(self, name: str, path: Sequence[str] | None = None, target: Any = None) -> ModuleSpec | None:
        """None for what is hidden."""
        if name.partition(".")[0] in self._modules:
            return None
        spec: ModuleSpec | None = self._finder.find_spec(name, path, target)
        return spec

    def find_distributions(self, *context: metadata.DistributionFinder.Context) -> Iterable[metadata.Distribution]:
        """All but those that are hidden."""
        if context and context[0].name in self._distributions:
            return ()
        find: Callable[..., Iterable[metadata.Distribution]] | None = getattr(self._finder, "find_distributions", None)
        return find(*context) if find else ()

    def invalidate_caches(self) -> None:
        """As the finder does."""
        if invalidate := getattr(self._finder, "invalidate_caches", None):
            invalidate()


def hide(modules: Sequence[str]) -> None:
    """Hide libraries from now on in this process, into which none of them has been imported.

    Raises:
        RuntimeError: If one has.
    """
    if loaded := sorted(set(modules) & sys.modules.keys()):
        raise RuntimeError(f"already imported: {', '.join(loaded)}")
    with suppress(ImportError):  # when imported, it puts a finder of all distributions in place of Python's own
        import_module("importlib_metadata")
    sys.meta_path[:] = [Without(finder, modules) for finder in sys.meta_path]
