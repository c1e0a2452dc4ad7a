"""The one writer: what is there keeps its kind, its mode and, where somebody else was quicker, its content."""

from __future__ import annotations

import os
import stat
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from phframe.core import InputError
from phframe.core.files import (
    NewFile,
    ThereAlreadyError,
    check_folder_writable,
    check_writable,
    write_file,
    write_folder,
)
from phframe.core.paths import user_path

posix = pytest.mark.skipif(os.name != "posix", reason="modes, devices and pipes of POSIX")
not_root = pytest.mark.skipif(getattr(os, "geteuid", lambda: 0)() == 0, reason="root may write everywhere")


def mode(path: Path) -> int:
    return stat.S_IMODE(path.stat().st_mode)


def left(folder: Path) -> list[str]:
    return sorted(each.name for each in folder.iterdir())


@pytest.fixture(params=[0o022, 0o077, 0o002], ids=oct)
def umask(request: pytest.FixtureRequest) -> Iterator[int]:
    before = os.umask(request.param)
    yield request.param
    os.umask(before)


@posix
def test_a_new_file_and_folder_have_the_mode_that_the_umask_leaves(umask: int, tmp_path: Path) -> None:
    assert mode(write_file(tmp_path / "new", "text")) == 0o666 & ~umask
    assert mode(write_file(tmp_path / "exclusive", "text", overwrite=False)) == 0o666 & ~umask
    write_folder(tmp_path / "folder", {"a": "text"})
    assert mode(tmp_path / "folder") == 0o777 & ~umask
    assert mode(tmp_path / "folder" / "a") == 0o666 & ~umask


@posix
@pytest.mark.parametrize("kept", [0o600, 0o640, 0o755])
def test_a_file_and_a_folder_that_are_there_keep_their_mode(kept: int, tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir(0o700)
    for path in (tmp_path / "file", tmp_path / "folder" / "a"):
        path.write_text("before")
        path.chmod(kept)
    write_file(tmp_path / "file", "after")
    write_folder(tmp_path / "folder", {"a": "after", "b": "new"}, overwrite=True)
    for path in (tmp_path / "file", tmp_path / "folder" / "a"):
        assert (mode(path), path.read_text()) == (kept, "after")
    assert mode(tmp_path / "folder") == 0o700


@posix
def test_what_replaces_a_secret_is_secret_while_it_is_written(tmp_path: Path) -> None:
    write_file(tmp_path / "secret", "before").chmod(0o600)
    with NewFile(tmp_path / "secret") as file:
        assert mode(file.part) == 0o600


def test_a_link_is_followed_and_stays(tmp_path: Path) -> None:
    (tmp_path / "there").mkdir()
    for name in ("old", "new"):
        (tmp_path / name).symlink_to(tmp_path / "there" / name)
    (tmp_path / "there" / "old").write_text("before")
    (tmp_path / "folder").symlink_to(tmp_path / "there" / "folder")
    for name in ("old", "new"):
        write_file(tmp_path / name, "after")
    write_folder(tmp_path / "folder", {"a": "text"})
    assert all((tmp_path / name).is_symlink() for name in ("old", "new", "folder"))
    assert {name: (tmp_path / "there" / name).read_text() for name in ("old", "new")} == dict.fromkeys(
        ("old", "new"), "after"
    )
    assert (tmp_path / "there" / "folder" / "a").read_text() == "text"
    assert left(tmp_path / "there") == ["folder", "new", "old"]


def test_a_loop_of_links_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    for write in (lambda path: write_file(path, ""), check_writable, lambda path: write_folder(path, {"a": ""})):
        with pytest.raises(InputError, match="cannot write"):
            write(tmp_path / "loop")
    assert (tmp_path / "loop").is_symlink()


@posix
def test_a_pipe_is_written_into_and_stays(tmp_path: Path) -> None:
    pipe, content = tmp_path / "pipe", "line\n" * 100_000  # more than a pipe holds
    os.mkfifo(pipe)
    both_ends = os.open(pipe, os.O_RDWR)  # so that it never ends before the writer comes
    with ThreadPoolExecutor(1) as pool, os.fdopen(both_ends) as stream:
        written = pool.submit(write_file, pipe, content, overwrite=False)
        assert stream.read(len(content)) == content
        written.result()
    assert stat.S_ISFIFO(pipe.stat().st_mode)
    assert left(tmp_path) == ["pipe"]


@posix
def test_a_pipe_that_nobody_reads_is_refused_without_waiting(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(InputError, match="nobody reads from this pipe"):
        write_file(tmp_path / "pipe", "text")
    assert stat.S_ISFIFO((tmp_path / "pipe").stat().st_mode)


@posix
def test_devices_are_written_into_and_stay(tmp_path: Path) -> None:
    null = Path(os.devnull)
    before = null.stat()
    (tmp_path / "link").symlink_to(null)
    for path in (null, tmp_path / "link"):
        check_writable(path, overwrite=False)
        write_file(path, "text", overwrite=False)
    assert (null.stat().st_rdev, null.stat().st_ino) == (before.st_rdev, before.st_ino)
    assert (tmp_path / "link").is_symlink()


@posix
def test_a_device_of_ones_own_stays(tmp_path: Path) -> None:
    device = tmp_path / "null"
    try:
        os.mknod(device, 0o666 | stat.S_IFCHR, os.makedev(1, 3))
        device.write_text("can it be opened?")
    except OSError as error:
        pytest.skip(f"only root makes devices: {error}")
    write_file(device, "text")
    assert stat.S_ISCHR(device.stat().st_mode)
    assert left(tmp_path) == ["null"]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no device that is always full")
def test_a_device_that_takes_nothing_is_one_line() -> None:
    with pytest.raises(InputError, match="cannot write /dev/full: no space left"):
        write_file(Path("/dev/full"), "text")


@posix
def test_a_socket_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import socket

    monkeypatch.chdir(tmp_path)  # its path may be 100 characters long
    with socket.socket(socket.AF_UNIX) as server:
        server.bind("socket")
        with pytest.raises(InputError, match="it is a block device or a socket"):
            write_file(Path("socket"), "text")
        assert stat.S_ISSOCK(Path("socket").stat().st_mode)


def test_of_many_who_make_a_file_at_once_one_makes_it(tmp_path: Path) -> None:
    ready = threading.Barrier(8)

    def make(number: int) -> bool:
        with NewFile(tmp_path / "one", overwrite=False) as file:  # none of them sees the file
            file.part.write_text(f"{number}")
            ready.wait()
            try:
                file.put()
            except ThereAlreadyError:
                return False
            return True

    with ThreadPoolExecutor(8) as pool:
        made = list(pool.map(make, range(8)))
    assert made.count(True) == 1
    assert (tmp_path / "one").read_text() == str(made.index(True))
    assert left(tmp_path) == ["one"]


def test_without_hard_links_nothing_is_overwritten_either(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: Any) -> None:
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(os, "link", refuse)
    with NewFile(tmp_path / "a", overwrite=False) as late:
        write_file(tmp_path / "a", "first", overwrite=False)
        with pytest.raises(ThereAlreadyError):
            late.put()
    assert (tmp_path / "a").read_text() == "first"
    assert left(tmp_path) == ["a"]


def test_a_folder_that_is_filled_meanwhile_is_not_touched(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Path, "rename", _filled_first(Path.rename))
    with pytest.raises(InputError, match="cannot write"):
        write_folder(tmp_path / "folder", {"a": "new"})
    assert (tmp_path / "folder" / "a").read_text() == "theirs"
    assert left(tmp_path) == ["folder"]


def _filled_first(rename: Any) -> Any:
    def filled(made: Path, place: Path) -> Any:
        place.mkdir()
        (place / "a").write_text("theirs")
        return rename(made, place)

    return filled


@pytest.mark.parametrize("there", [True, False], ids=["over another", "new"])
def test_nothing_is_left_of_what_fails_half_way(there: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "file"
    if there:
        path.write_text("before")
    before = left(tmp_path)

    def full(*_: Any, **__: Any) -> None:
        raise OSError(28, "No space left on device")

    def interrupted(*_: Any, **__: Any) -> None:
        raise KeyboardInterrupt

    for step in ("write_bytes", "replace"):
        for failure, error in ((full, InputError), (interrupted, KeyboardInterrupt)):
            with monkeypatch.context() as patched:
                patched.setattr(Path, step, failure)
                with pytest.raises(error):
                    write_file(path, "after")
                with pytest.raises(error):
                    write_folder(tmp_path, {"file": "after", "other": ""}, overwrite=True)
            assert left(tmp_path) == before
            assert not there or path.read_text() == "before"


def test_a_new_folder_is_whole_or_not_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot write"):
        write_folder(tmp_path / "folder", {"a": "text", "x" * 300: "too long a name"})
    assert left(tmp_path) == []
    write_folder(tmp_path / "deep" / "folder", {"a": "text", "b/c": "text"})
    assert left(tmp_path / "deep" / "folder") == ["a", "b"]


def test_an_empty_folder_is_filled_where_it_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write_folder(Path(), {"a": "text"})
    assert Path("a").read_text() == "text"
    with pytest.raises(ThereAlreadyError, match="not empty"):
        write_folder(Path(), {"b": "text"})
    write_folder(Path(), {"b": "text"}, overwrite=True)
    assert left(tmp_path) == ["a", "b"]


def test_as_long_a_name_as_a_file_may_have(tmp_path: Path) -> None:
    assert write_file(tmp_path / ("ä" * 127), "text").read_text() == "text"


BAD = {
    "folder": "directory",
    "file/below": "cannot write",
    "x" * 300: "cannot write",
    "zero\0byte": "cannot write",
    "line\nbreak" * 40: "cannot write",
}


@pytest.mark.parametrize("name", BAD, ids=lambda name: ascii(name)[:20])
def test_what_cannot_be_written_is_one_line_before_and_when_it_is_written(name: str, tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").touch()
    for write in (check_writable, lambda path: write_file(path, "text")):
        with pytest.raises(InputError, match=BAD[name]) as caught:
            write(tmp_path / name)
        assert str(caught.value).isprintable()
    assert left(tmp_path) == ["file", "folder"]


def test_a_file_is_no_folder_and_what_is_below_a_file_is_none(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    for check in (check_folder_writable, lambda path: write_folder(path, {"a": ""}, overwrite=True)):
        with pytest.raises(InputError, match="there is a file"):
            check(tmp_path / "file")
        with pytest.raises(InputError, match="cannot write"):
            check(tmp_path / "file" / "below")
    assert left(tmp_path) == ["file"]


@not_root
def test_what_is_protected_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("before")
    (tmp_path / "file").chmod(0o400)
    with pytest.raises(InputError, match="permission denied"):
        write_file(tmp_path / "file", "after")
    tmp_path.chmod(0o500)
    try:
        for name in ("new", "deep/er"):
            with pytest.raises(InputError, match="permission denied"):
                check_writable(tmp_path / name)
    finally:
        tmp_path.chmod(0o700)
    assert (tmp_path / "file").read_text() == "before"


def test_a_check_leaves_nothing(tmp_path: Path) -> None:
    check_writable(tmp_path / "deep" / "file")
    check_folder_writable(tmp_path / "deep" / "folder")
    assert left(tmp_path) == []


@pytest.mark.parametrize("text", ["", "a\0b", "\ud800", "~no-such-user/x"])
def test_what_is_no_path_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="is not a path") as caught:
        user_path(text)
    assert str(caught.value).isprintable()


def test_a_tilde_is_the_home(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("USERPROFILE", str(tmp_path))
    assert user_path("~/x") == tmp_path / "x"


@posix
@pytest.mark.parametrize("before", ["file", "nothing"])
def test_a_link_or_a_pipe_that_is_put_there_while_a_file_is_written_stays(before: str, tmp_path: Path) -> None:
    for put in (lambda path: path.symlink_to(tmp_path / "elsewhere"), os.mkfifo):
        path = tmp_path / "place"
        if before == "file":
            path.write_text("before")
        with NewFile(path) as file:
            path.unlink(missing_ok=True)
            put(path)
            status = path.lstat()
            with pytest.raises(InputError, match="what is there now is no regular file"):
                file.put()
        assert path.lstat().st_ino == status.st_ino
        path.unlink()
        assert left(tmp_path) == []
