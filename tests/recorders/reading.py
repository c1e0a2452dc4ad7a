"""Reads a recording back with Rerun's own reader."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

rr = pytest.importorskip("rerun")


class Recording:
    """All that was written, by entity and component."""

    def __init__(self, path: Path) -> None:
        reader = rr.chunk.RrdReader(path)
        self.application = reader.recordings()[0].application_id
        self.blueprints = len(reader.blueprints())
        self.views = _views(reader)
        self._chunks = reader.stream().to_chunks()

    @property
    def entities(self) -> set[str]:
        """Every entity that has data."""
        return {chunk.entity_path for chunk in self._chunks}

    @property
    def timelines(self) -> set[str]:
        """Every timeline."""
        return {name for chunk in self._chunks for name in chunk.timeline_names}

    def rows(self, entity: str, component: str) -> list[tuple[float, int, Any]]:
        """Seconds, action and value of everything written over time, in the order of time."""
        found = [row for batch in self._batches(entity, static=False) for row in _rows(batch, component)]
        return sorted(found, key=lambda row: row[0])

    def constant(self, entity: str, component: str) -> Any:
        """What holds at all times."""
        values = [value for batch in self._batches(entity, static=True) for value in _values(batch, component)]
        assert len(values) == 1, f"{entity} has {len(values)} constant values of {component}"
        return values[0]

    def is_constant(self, entity: str, component: str) -> bool:
        """Whether something holds at all times: it would hide what is written over time."""
        return any(_values(batch, component) for batch in self._batches(entity, static=True))

    def _batches(self, entity: str, *, static: bool) -> list[Any]:
        return [c.to_record_batch() for c in self._chunks if c.entity_path == entity and c.is_static is static]


def _rows(batch: Any, component: str) -> list[tuple[float, int, Any]]:
    nanoseconds = batch.column("sim_time").cast("int64").to_pylist()
    actions, values = batch.column("action").to_pylist(), _values(batch, component)
    together = zip(nanoseconds, actions, values, strict=True) if values else ()
    return [(time / 1e9, action, value) for time, action, value in together if value is not None]


def _values(batch: Any, component: str) -> list[Any]:
    named = [name for name in batch.schema.names if name.rpartition(":")[2] == component]
    return [] if not named else list(batch.column(named[0]).to_pylist())


def _views(reader: Any) -> set[str]:
    """What the views of the blueprints are called."""
    names: set[str] = set()
    for entry in reader.blueprints():
        for chunk in reader.stream(store=entry).to_chunks():
            if chunk.entity_path.startswith("/view/"):
                names.update(name for value in _values(chunk.to_record_batch(), "display_name") for name in value or ())
    return names
