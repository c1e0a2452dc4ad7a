"""The results of a bench in one SQLite file, which a crash at any moment leaves whole."""

from __future__ import annotations

import sqlite3
from collections.abc import Generator, Iterable, Iterator, Mapping
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from types import MappingProxyType, TracebackType
from typing import Any, Self

from phframe.bench.environment import Environment
from phframe.bench.rows import COLUMNS, DECLARED, from_row, to_row
from phframe.bench.settings import BenchSettings
from phframe.bench.trial_result import TrialResult
from phframe.core import InputError
from phframe.core.paths import path_shown

FILE = "results.sqlite"
"""What the file is called in a bench's directory."""
FILES = (FILE, *(f"{FILE}-{part}" for part in ("wal", "shm", "journal")))
"""This file and those that SQLite has beside it."""
FORMAT = 1
"""Of the tables, as the database's ``user_version``; a file of another one is refused."""
BUSY = 60.0
"""Seconds to wait for another process that writes."""

_SCHEMA = f"""
CREATE TABLE bench (settings TEXT NOT NULL);
CREATE TABLE problems (name TEXT PRIMARY KEY, digest TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE environments (number INTEGER PRIMARY KEY, id TEXT UNIQUE NOT NULL, content TEXT NOT NULL);
CREATE TABLE results (key TEXT PRIMARY KEY, {DECLARED}, retired INTEGER NOT NULL DEFAULT 0);
CREATE INDEX results_in_order ON results (retired, suite, problem, planner, seed, key);
CREATE TABLE faults (key TEXT PRIMARY KEY, content TEXT NOT NULL) WITHOUT ROWID;
PRAGMA user_version = {FORMAT};
"""
_ALL = ", ".join(COLUMNS)
_ORDER = "suite, problem, planner, seed, key"


class StoreError(InputError):
    """The file of a bench's results cannot be read or written; what it held stays."""


class ResultStore:
    """The results of a bench. Each ``add`` is there for good when it returns, whatever happens to the process then.

    Make one with ``create`` or ``open``; close it, or use it in a ``with``. Every method raises ``StoreError`` where the
    file cannot be read or written.

    Args:
        path: The file.
        connection: To it.
    """

    def __init__(self, path: Path, connection: sqlite3.Connection) -> None:
        self.path, self._connection = path, connection

    @classmethod
    def create(
        cls, directory: str | Path, settings: BenchSettings, problems: Mapping[str, str] = MappingProxyType({})
    ) -> Self:
        """A new store in a directory, which is made if need be.

        Args:
            directory: Where.
            settings: What the bench runs.
            problems: A digest of every scene, by ``suite/name``.

        Raises:
            StoreError: If there is one already, or it cannot be made.
        """
        path = Path(directory) / FILE
        with _told(path):
            path.parent.mkdir(parents=True, exist_ok=True)
            store = cls(path, _connected(path, read_only=False))
            try:
                store._make(settings, problems)
            except BaseException:
                store.close()
                raise
        return store

    @classmethod
    def is_in(cls, directory: str | Path) -> bool:
        """Whether a directory holds a store, damaged or not. One whose making was cut short is none."""
        path = Path(directory) / FILE
        if path.exists() and not path.is_file():  # SQLite would wait for a pipe for ever
            return True
        try:
            with closing(cls(path, _connected(path, read_only=True))) as store:
                return not store._is_empty
        except sqlite3.OperationalError:  # there is no file
            return path.exists()
        except StoreError:
            return True

    @classmethod
    def open(cls, directory: str | Path, *, read_only: bool = True) -> Self:
        """The store in a directory.

        Raises:
            StoreError: If there is none, it is damaged, or of another format.
        """
        path = Path(directory) / FILE
        if not path.is_file():
            why = "is not a regular file" if path.exists() else "is not in it"
            raise StoreError(f"{path_shown(directory)} holds no bench: {FILE} {why}")
        with _told(path):
            store = cls(path, _connected(path, read_only=read_only))
            try:
                store._check()
            except BaseException:
                store.close()
                raise
        return store

    def close(self) -> None:
        """Close the file, which is then the only one of the store, unless somebody else has it open. May be called twice."""
        with suppress(sqlite3.Error):  # closed already, or in use elsewhere, or nothing that is written
            self._connection.execute("PRAGMA busy_timeout = 0")
            self._connection.execute("PRAGMA journal_mode = DELETE")
        self._connection.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def settings(self) -> BenchSettings:
        """What the bench runs."""
        with self._whole():
            return BenchSettings.from_json(str(self._one("SELECT settings FROM bench")))

    def results(self) -> Generator[TrialResult, None, None]:
        """All results, one by one, ordered by suite, problem, planner and seed. Retired ones are left out.

        Close the iterator before the store, unless it has come to its end.
        """
        with _told(self.path), closing(self._connection.cursor()) as cursor:
            for row in cursor.execute(f"SELECT {_ALL} FROM results WHERE NOT retired ORDER BY {_ORDER}"):
                yield self._read(row)

    def result(self, key: str) -> TrialResult | None:
        """The result of one trial, a retired one too; None: it has none."""
        with _told(self.path):
            row = self._connection.execute(f"SELECT {_ALL} FROM results WHERE key = ?", (key,)).fetchone()
        return None if row is None else self._read(row)

    def find(self, *words: str) -> list[TrialResult]:
        """The results that are meant by the beginning of a key, or by a problem, planner and seed; retired ones left out."""
        where = (
            "substr(key, 1, length(?1)) = ?1 AND ?1 <> ''"
            if len(words) == 1
            else "problem = ? AND planner = ? AND CAST(seed AS TEXT) = ?"
        )
        query = f"SELECT {_ALL} FROM results WHERE {where} AND NOT retired ORDER BY {_ORDER}"
        with _told(self.path), suppress(UnicodeEncodeError):  # no result has what UTF-8 cannot hold
            return [self._read(row) for row in self._connection.execute(query, words)]
        return []

    def add(self, result: TrialResult, *, fault: str = "", replace: bool = False) -> bool:
        """Store a result.

        Args:
            result: The result.
            fault: What helps to find out why the trial went wrong: a traceback, the last that it printed.
            replace: Whether it takes the place of the trial's earlier result; else that one is kept.

        Returns:
            Whether it was stored.
        """
        verb = "REPLACE" if replace else "INSERT OR IGNORE"
        marks = ", ".join("?" * len(COLUMNS))
        with self._transaction():
            done = self._connection.execute(f"{verb} INTO results ({_ALL}) VALUES ({marks})", to_row(result))
            if done.rowcount > 0:
                self._connection.execute("DELETE FROM faults WHERE key = ?", (result.key,))
            if done.rowcount > 0 and fault:
                self._connection.execute("INSERT INTO faults VALUES (?, ?)", (result.key, fault))
        return done.rowcount > 0

    def done(self) -> set[str]:
        """The keys of the trials that have a result, retired ones too."""
        with _told(self.path):
            return {key for (key,) in self._connection.execute("SELECT key FROM results")}

    def fault(self, key: str) -> str:
        """What is known about why a trial went wrong; empty: nothing."""
        return str(self._one("SELECT content FROM faults WHERE key = ?", key) or "")

    def environments(self) -> dict[str, Environment]:
        """Where the trials ran, by the id that results have, in the order of their first use."""
        with _told(self.path):
            rows = self._connection.execute("SELECT id, content FROM environments ORDER BY number").fetchall()
        with self._whole():
            return {name: Environment.from_json(content) for name, content in rows}

    def add_environment(self, environment: Environment) -> str:
        """Store where trials run; its id."""
        with self._transaction():
            row = (environment.id, environment.to_json())
            self._connection.execute("INSERT OR IGNORE INTO environments (id, content) VALUES (?, ?)", row)
        return environment.id

    def problems(self) -> dict[str, str]:
        """A digest of every scene of the bench, by ``suite/name``."""
        with _told(self.path):
            return dict(self._connection.execute("SELECT name, digest FROM problems ORDER BY name").fetchall())

    def set_plan(self, settings: BenchSettings, keys: Iterable[str], problems: Mapping[str, str]) -> int:
        """Say anew what the bench runs. Results of other trials are retired: kept, but no part of it.

        So are those on another scene of the same name; they count again when the bench has that scene again.

        Args:
            settings: What it runs.
            keys: Of all its trials.
            problems: A digest of every scene, by ``suite/name``.

        Returns:
            How many results that were a part of it are none any more.
        """
        with self._transaction():
            self._rename_by_scene(problems)
            self._connection.execute("UPDATE bench SET settings = ?", (settings.to_json(),))
            self._connection.execute("DELETE FROM problems")
            self._connection.executemany("INSERT INTO problems VALUES (?, ?)", problems.items())
            self._connection.execute("CREATE TEMP TABLE planned (key TEXT PRIMARY KEY)")
            self._connection.executemany("INSERT OR IGNORE INTO planned VALUES (?)", ((key,) for key in keys))
            left_out = int(
                self._one("SELECT count(*) FROM results WHERE NOT retired AND key NOT IN (SELECT key FROM planned)")
            )
            self._connection.execute("UPDATE results SET retired = key NOT IN (SELECT key FROM planned)")
            self._connection.execute("DROP TABLE planned")
        return left_out

    def _rename_by_scene(self, problems: Mapping[str, str]) -> None:
        """Give the results on scenes that go keys of no trial, ``key@digest``, and those on scenes that are back theirs."""
        before = self.problems()
        known = [
            (key.partition("@"), problem)
            for key, problem in self._connection.execute("SELECT key, problem FROM results")
        ]
        going = [
            (f"{key}@{before[problem]}", key)
            for (key, mark, _), problem in known
            if not mark and problem in before and before[problem] != problems.get(problem)
        ]
        back = [
            (key, f"{key}@{digest}")
            for (key, mark, digest), problem in known
            if mark and problems.get(problem) == digest
        ]
        for table in ("results", "faults"):
            self._connection.executemany(f"UPDATE OR REPLACE {table} SET key = ? WHERE key = ?", [*going, *back])

    def _make(self, settings: BenchSettings, problems: Mapping[str, str]) -> None:
        """Make the tables, all at once."""
        with self._transaction():
            if not self._is_empty:
                raise StoreError(f"{path_shown(self.path)} is there already: it holds another bench")
            for statement in filter(str.strip, _SCHEMA.split(";")):
                self._connection.execute(statement)
            self._connection.execute("INSERT INTO bench VALUES (?)", (settings.to_json(),))
            self._connection.executemany("INSERT INTO problems VALUES (?, ?)", problems.items())

    @property
    def _is_empty(self) -> bool:
        return not self._one("SELECT count(*) FROM sqlite_master")

    def _check(self) -> None:
        """See that this is a whole store of this format."""
        found = self._one("PRAGMA user_version")
        if found != FORMAT:
            raise StoreError(f"{path_shown(self.path)} is of format {found}; this phframe reads format {FORMAT}")
        complaint = self._one("PRAGMA quick_check(1)")
        if complaint != "ok":
            raise StoreError(f"{path_shown(self.path)} is damaged: {' '.join(str(complaint).split())}")
        self.settings  # noqa: B018 - refuses what it cannot read

    def _read(self, row: tuple[Any, ...]) -> TrialResult:
        with self._whole():
            return from_row(row)

    @contextmanager
    def _whole(self) -> Iterator[None]:
        """What cannot be read although SQLite has it, as an error for people."""
        try:
            yield
        except StoreError:
            raise
        except (InputError, ValueError) as error:
            raise StoreError(f"{path_shown(self.path)} is damaged: {' '.join(str(error).split())}") from None

    def _one(self, query: str, *values: Any) -> Any:
        with _told(self.path):
            row = self._connection.execute(query, values).fetchone()
        return None if row is None else row[0]

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        """All of it is stored, or nothing."""
        with _told(self.path):
            self._connection.execute("BEGIN IMMEDIATE")
            with self._connection:
                yield


def _connected(path: Path, *, read_only: bool) -> sqlite3.Connection:
    connection = sqlite3.connect(f"{path.absolute().as_uri()}{'?mode=ro' if read_only else ''}", BUSY, uri=True)
    connection.isolation_level = None
    if not read_only:
        connection.execute("PRAGMA journal_mode = WAL")
        connection.execute("PRAGMA synchronous = NORMAL")
    return connection


@contextmanager
def _told(path: Path) -> Iterator[None]:
    """What SQLite and the system refuse, as an error for people."""
    try:
        yield
    except (sqlite3.Error, OSError, ValueError) as error:
        why = " ".join(str(getattr(error, "strerror", None) or error).split())
        raise StoreError(
            f"cannot use {path_shown(path)}: {why[:1].lower()}{why[1:]}. What is stored stays; see that the disk has room "
            "and the file can be written, or name another directory"
        ) from None
