"""Files written, linked, replaced and removed in any order: what is asked for is done whole, or nothing is, and said so."""

from __future__ import annotations

import errno
import os
import shutil
import stat
import sys
import tempfile
from collections.abc import Callable
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any
from unittest.mock import patch

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule, run_state_machine_as_test

from phframe.cli.run_directory import RunDirectory
from phframe.core import InputError
from phframe.core.files import (
    NewFile,
    check_folder_writable,
    check_writable,
    new_folder,
    write_file,
    write_file_by,
    write_folder,
)
from tests.faults.files.spoiling import a_line
from tests.trials import many, tried

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="links, pipes and modes of POSIX")
NAMES = st.sampled_from(("a", "b", "c", "d/a", "d/b", "d/e/a", "d", "a/x"))
CONTENTS = st.sampled_from(("", "text", "longer text\n" * 50, "é"))
MODES = st.sampled_from((0o600, 0o640, 0o644, 0o755, 0o400))
Tree = dict[str, tuple[object, ...]]


def tree(folder: Path) -> Tree:
    """All that is below a folder: kind, mode, and what it holds or leads to."""
    found: Tree = {}
    for parent, folders, files in os.walk(folder):
        for path in (Path(parent, name) for name in (*folders, *files)):
            status = path.lstat()
            kind = stat.S_IFMT(status.st_mode)
            held: object = None
            if stat.S_ISLNK(kind):
                held = str(path.readlink())
            elif stat.S_ISREG(kind):
                held = path.read_bytes()
            found[str(path.relative_to(folder))] = (kind, stat.S_IMODE(status.st_mode), held)
    return found


class FilesInAnyOrder(RuleBasedStateMachine):
    """A folder in which a program writes, and somebody else does what people do."""

    def __init__(self) -> None:
        super().__init__()
        self.stack = ExitStack()
        self.place = Path(self.stack.enter_context(tempfile.TemporaryDirectory())).resolve() / "place"
        self.place.mkdir()
        self.open: list[tuple[NewFile, bytes]] = []

    def teardown(self) -> None:
        for file, _ in self.open:
            file.close()
        self.stack.close()

    # What people do

    @rule(name=NAMES, content=CONTENTS, mode=MODES)
    def somebody_writes(self, name: str, content: str, mode: int) -> None:
        path = self.place / name
        with suppress(OSError):
            path.parent.mkdir(parents=True, exist_ok=True)
            if not path.is_fifo():
                path.write_text(content)
                path.chmod(mode)

    @rule(name=NAMES)
    def somebody_removes(self, name: str) -> None:
        path = self.place / name
        with suppress(OSError):
            if path.is_dir() and not path.is_symlink():
                shutil.rmtree(path)
            else:
                path.unlink()

    @rule(name=NAMES, to=NAMES)
    def somebody_links(self, name: str, to: str) -> None:
        with suppress(OSError):
            (self.place / name).symlink_to(self.place / to)

    @rule(name=NAMES, to=NAMES)
    def somebody_moves(self, name: str, to: str) -> None:
        with suppress(OSError):
            (self.place / name).rename(self.place / to)

    @rule(name=NAMES)
    def somebody_makes_a_folder(self, name: str) -> None:
        with suppress(OSError):
            (self.place / name).mkdir(parents=True)

    @rule(name=NAMES)
    def somebody_makes_a_pipe(self, name: str) -> None:
        with suppress(OSError):
            os.mkfifo(self.place / name)

    # What the program does

    @rule(name=NAMES, content=CONTENTS, overwrite=st.booleans())
    def write(self, name: str, content: str, overwrite: bool) -> None:
        path = self.place / name
        possible = self._asked(lambda: check_writable(path, overwrite=overwrite))
        before = tree(self.place)
        if self._asked(lambda: write_file(path, content, overwrite=overwrite)):
            assert possible or path.is_fifo()
            self._changed(before, {path: content.encode()}, overwrite)
        else:
            assert tree(self.place) == before
            assert not possible or path.is_fifo(), "what can be written is"

    @rule(name=NAMES, fault=st.sampled_from((OSError(errno.ENOSPC, "No space left on device"), KeyboardInterrupt())))
    def write_half(self, name: str, fault: BaseException) -> None:
        def half(part: Path) -> None:
            part.write_text("half of")
            raise fault

        before = tree(self.place)
        with suppress(InputError, KeyboardInterrupt):
            write_file_by(self.place / name, half)
            pytest.fail("it cannot be written")
        self._only_folders_are_new(before)

    @rule(name=NAMES, content=CONTENTS)
    def write_to_a_full_disk(self, name: str, content: str) -> None:
        before = tree(self.place)
        with full_disk():
            written = self._asked(lambda: write_file(self.place / name, content))
        assert not written
        self._only_folders_are_new(before)

    @rule(name=NAMES, content=CONTENTS, overwrite=st.booleans())
    def begin(self, name: str, content: str, overwrite: bool) -> None:
        with suppress(InputError):
            file = NewFile(self.place / name, overwrite=overwrite)
            with suppress(FileNotFoundError):
                file.part.write_text(content)
            self.open.append((file, content.encode()))

    @precondition(lambda self: self.open)
    @rule(number=st.integers(0, 3))
    def put(self, number: int) -> None:
        file, content = self.open.pop(number % len(self.open))
        before, there = tree(self.place), file.path.exists()
        part = str(file.part.relative_to(self.place)) if file.part.is_relative_to(self.place) else ""
        if self._asked(file.put):
            if not file.path.is_fifo():
                assert file.path.read_bytes() == content
                assert file._overwrite or not there, "nothing is overwritten unasked"
        else:
            before.pop(part, None)
            assert tree(self.place) == before

    @rule(
        name=NAMES,
        files=st.dictionaries(st.sampled_from(("a", "b", "e/a")), CONTENTS, max_size=3),
        overwrite=st.booleans(),
    )
    def write_a_folder(self, name: str, files: dict[str, str], overwrite: bool) -> None:
        path = self.place / name
        possible = self._asked(lambda: check_folder_writable(path, overwrite=overwrite))
        before, was = tree(self.place), path.exists()
        if self._asked(lambda: write_folder(path, files, overwrite=overwrite)):
            assert possible
            assert {
                each: (path / each).read_text() for each in files if not (path / each).is_fifo()
            }.items() <= files.items()
        elif was:
            self._only_folders_are_new(before)
        else:
            assert tree(self.place) == before or not possible

    @rule(name=NAMES)
    def fill_half_a_folder(self, name: str) -> None:
        before = tree(self.place)
        with suppress(InputError, ZeroDivisionError), new_folder(self.place / name) as made:
            (made / "a").write_text("half of")
            raise ZeroDivisionError
        self._only_folders_are_new(before)

    @invariant()
    def nothing_half_is_left(self) -> None:
        known = {file.part for file, _ in self.open}
        assert set(self.place.rglob("*.part")) <= known

    def _asked(self, do: Callable[[], object]) -> bool:
        """Whether it was done; what is not done is told in a line."""
        tried("inputs: files written in any order")
        try:
            do()
        except InputError as error:
            a_line(error)
            return False
        return True

    def _changed(self, before: Tree, files: dict[Path, bytes], overwrite: bool) -> None:
        """See that nothing but some files was changed: they hold what they should, and are of the mode that they had."""
        after = tree(self.place)
        for path, content in files.items():
            place = str(path.resolve().relative_to(self.place))
            kind, mode, held = after.pop(place)
            had = before.pop(place, None)
            if kind == stat.S_IFIFO:
                assert had is not None
                continue
            assert (kind, held) == (stat.S_IFREG, content)
            assert had is None or (overwrite and had[1] == mode and had[0] == stat.S_IFREG)
        assert {name: each for name, each in after.items() if name in before} == before
        assert all(each[0] == stat.S_IFDIR for name, each in after.items() if name not in before)

    def _only_folders_are_new(self, before: Tree) -> None:
        self._changed(before, {}, overwrite=False)


@contextmanager
def full_disk() -> Any:
    """Meanwhile nothing can be written."""

    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with patch.object(Path, "write_bytes", full):
        yield


class RunsInAnyOrder(RuleBasedStateMachine):
    """Runs that are given a few directories, while somebody fills and removes them."""

    def __init__(self) -> None:
        super().__init__()
        self.stack = ExitStack()
        self.place = Path(self.stack.enter_context(tempfile.TemporaryDirectory())).resolve()
        before = Path.cwd()
        os.chdir(self.place)
        self.stack.callback(os.chdir, before)
        self.running: dict[Path, RunDirectory] = {}
        self.inodes: dict[Path, int] = {}

    def teardown(self) -> None:
        self.stack.close()

    @rule(name=st.sampled_from(("a", "b", "deep/c")))
    def begin(self, name: str) -> None:
        path = Path(name)
        used = path in self.running and path.is_dir() and self.running[path].path is not None
        filled = path.exists() and (not path.is_dir() or any(path.iterdir()))
        before = tree(self.place)
        tried("inputs: runs begun and ended in any order")
        try:
            run = RunDirectory(path)
            made = run.make()
        except InputError as error:
            a_line(error)
            assert tree(self.place) == before
            return
        assert not filled
        assert made == path
        assert list(path.iterdir()) == []
        if used:
            assert path.stat().st_ino != self.inodes[path], "two runs have one directory"
        self.running[path] = run
        self.inodes[path] = path.stat().st_ino

    @rule()
    def begin_somewhere(self) -> None:
        before = set(tree(self.place))
        made = RunDirectory(None).make("s", "../p")
        assert set(tree(self.place)) - before == {str(made)} | ({"runs"} - before)

    @rule(name=st.sampled_from(("a", "b", "deep/c")))
    def fill(self, name: str) -> None:
        with suppress(OSError):
            write_file(Path(name, "file"), "text")

    @rule(name=st.sampled_from(("a", "b", "deep/c")))
    def empty(self, name: str) -> None:
        with suppress(OSError):
            Path(name, "file").unlink()

    @rule(name=st.sampled_from(("a", "b", "deep/c")))
    def remove(self, name: str) -> None:
        shutil.rmtree(name, ignore_errors=True)

    @precondition(lambda self: self.running)
    @rule(number=st.integers(0, 2))
    def end(self, number: int) -> None:
        path = sorted(self.running)[number % len(self.running)]
        kept = path.is_dir() and any(path.iterdir())
        self.running.pop(path).discard_if_empty()
        assert path.exists() is kept


@pytest.mark.parametrize("machine", [FilesInAnyOrder, RunsInAnyOrder])
def test_files_in_any_order(machine: type[RuleBasedStateMachine]) -> None:
    run_state_machine_as_test(machine, settings=settings(max_examples=many(20), stateful_step_count=25, deadline=None))
