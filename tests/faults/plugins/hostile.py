"""Distributions that do what no plugin should: each kind as a folder of metadata and a module, as an installer leaves them."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from textwrap import dedent

HEADER = """
import os, sys, threading, time
with open(os.path.join(os.environ['RAN'], MODULE), 'a') as ran:
    ran.write(f'{os.getpid()}\\n')
from phframe.registry import Extension, Kind, hookimpl
"""
OFFER = """
@hookimpl
def phframe_extensions():
    return [Extension(Kind.PLANNER, MODULE.replace('_', '-'), MODULE + '_class:Mine', "A lab's", api_version=2)]
"""
CLASS = """
from phframe.planners.ooa import OOA
class Mine(OOA):
    pass
"""
FIFO = b"FIFO"
"""Stands for a pipe in place of a file."""


@dataclass(frozen=True)
class Hostile:
    """One kind of hostile distribution.

    Attributes:
        name: Of it; its planner is called like it, its module so with underscores.
        said: Part of what the listing says of it; None: it is harmless in the end, and its planner is listed.
        source: Of its module, after ``HEADER``.
        entry_points: The file; None: one that names the module.
        metadata: The file; None: one that is right. Empty: there is none.
        known_as: What the listing calls it.
    """

    name: str
    said: str | None
    source: str = OFFER
    entry_points: bytes | None = None
    metadata: bytes | None = None
    known_as: str = ""

    @property
    def module(self) -> str:
        return self.name.replace("-", "_")

    def install(self, site: Path) -> None:
        """Into a folder that is on the path."""
        info = site / f"{self.module}-1.0.dist-info"
        info.mkdir(parents=True)
        metadata = f"Metadata-Version: 2.1\nName: {self.name}\nVersion: 1.0\n\nText\n".encode()
        _write(info / "METADATA", metadata if self.metadata is None else self.metadata)
        points = f"[console_scripts]\nx = y:z\n[phframe]\nplugin = {self.module}\n".encode()
        _write(info / "entry_points.txt", points if self.entry_points is None else self.entry_points)
        for name, source in (("", dedent(HEADER) + dedent(self.source)), ("_class", CLASS)):
            (site / f"{self.module}{name}.py").write_text(source.replace("MODULE", repr(self.module)), encoding="utf-8")


def _write(path: Path, content: bytes) -> None:
    if content == FIFO:
        os.mkfifo(path)
    elif content:
        path.write_bytes(content)


def returning(expression: str, before: str = "") -> str:
    """Source whose hook returns what an expression says."""
    return f"{dedent(before)}\n@hookimpl\ndef phframe_extensions():\n    return {expression}\n"


def offering(**changed: str) -> str:
    """Source of an extension some of whose fields are other expressions."""
    fields = {"kind": "Kind.PLANNER", "name": "'lab'", "target": "'lab:Mine'", "summary": "'x'", "api_version": "2"}
    return returning(f"[Extension({', '.join(f'{key}={value}' for key, value in {**fields, **changed}.items())})]")


BAD_TEXT = """
class Mute(Exception):
    def __str__(self):
        raise RuntimeError("no text")
raise Mute
"""
BAD_CLASS = """
class Meta(type):
    @property
    def __name__(cls):
        raise RuntimeError("no name")
    @property
    def __class__(cls):
        raise RuntimeError("no class")
class Mute(Exception, metaclass=Meta):
    def __str__(self):
        return 3
raise Mute
"""
ENDLESS = """
class X(list):
    def __iter__(self):
        while True:
            yield Extension(Kind.PLANNER, 'lab', 'lab:Mine', 'x', api_version=2)
    def __getitem__(self, part):
        return self
"""
ENDED = "it ended the process"

ENDS_THE_PROCESS = (
    Hostile("lab-exits", f"{ENDED} with exit code 0", "os._exit(0)"),
    Hostile("lab-exits-five", f"{ENDED} with exit code 5", returning("os._exit(5)")),
    Hostile("lab-segfault", f"{ENDED} by the signal SIGSEGV", "import ctypes; ctypes.string_at(0)"),
    Hostile("lab-abort", f"{ENDED} by the signal SIGABRT", "os.abort()"),
    Hostile("lab-kills-itself", f"{ENDED} by the signal SIGKILL", "os.kill(os.getpid(), 9)"),
    Hostile("lab-kills-its-group", f"{ENDED} by the signal SIGTERM", "os.killpg(0, 15)"),
    Hostile("lab-becomes-another", f"{ENDED} with exit code 0", "os.execv('/bin/true', ['true'])"),
    Hostile("lab-sys-exit", "SystemExit: 0", "sys.exit(0)"),
    Hostile("lab-interrupts", "KeyboardInterrupt", "raise KeyboardInterrupt"),
    Hostile("lab-base-exception", "Mine: two lines", "class Mine(BaseException): pass\nraise Mine('two\\nlines')"),
)
RAISES = (
    Hostile("lab-no-text", "Mute: it cannot say what is wrong", BAD_TEXT),
    Hostile("lab-no-class", "Mute: it cannot say what is wrong", BAD_CLASS),
    Hostile("lab-long-text", "ValueError: xxx", "raise ValueError('x' * 10**8)"),
    Hostile("lab-control-text", "ValueError: ", "raise ValueError('\\x1b[31m\\u202e\\ud800')"),
    Hostile("lab-recursion", "RecursionError", "def f(): f()\nf()"),
    Hostile("lab-syntax", "SyntaxError", "def f(:"),
    Hostile("lab-null-bytes", "null bytes", "x = '\0'"),
    Hostile("lab-lacks", "No module named 'no_such_module'", "import no_such_module"),
    Hostile("lab-group", "ExceptionGroup", "raise ExceptionGroup('several', [ValueError(), KeyError()])"),
)
GREEDY = (
    Hostile("lab-memory", "it asked for more memory than the 2048 MB", "x = b'x' * (3 << 30)"),
    Hostile("lab-memory-by-bits", "it asked for more memory", "x = []\nwhile True: x.append(b'x' * (1 << 24))"),
    Hostile(
        "lab-many",
        "it offers 200000 extensions; one distribution may offer 1000",
        returning("[Extension(Kind.PLANNER, f'lab-{n}', 'lab:Mine', 'x', api_version=2) for n in range(200_000)]"),
    ),
    Hostile("lab-long-summary", "is no line of at most 300 printable characters", offering(summary="'x' * 10**7")),
)
ANSWERS_NONSENSE = (
    Hostile("lab-no-hook", "no function phframe_extensions()", "def phframe_extensions(): return []"),
    Hostile("lab-no-list", "returned a generator, not a list", returning("(x for x in ())")),
    Hostile("lab-no-extensions", "returned 3 among its extensions", returning("[3]")),
    Hostile("lab-repr", "RuntimeError", returning("[X()]", "class X:\n    def __repr__(self): raise RuntimeError")),
    Hostile("lab-wrong-hook", "PluginValidationError", "@hookimpl\ndef phframe_extension(): return []"),
    Hostile("lab-control-name", "a name is lower-case words", offering(name="'a\\x1b[31m\\n'")),
    Hostile("lab-control-summary", "printable characters", offering(summary="'a\\x1b]0;title\\x07'")),
    Hostile("lab-surrogate", "printable characters", offering(summary="'\\ud800'")),
    Hostile("lab-no-target", "is not 'module:Class'", offering(target="'../../etc/passwd'")),
    Hostile("lab-number", "a name is lower-case words", offering(name="3")),
    Hostile("lab-version-text", "the api_version '2' is no whole number", offering(api_version="'2'")),
    Hostile("lab-version-next", "upgrade phframe", offering(api_version="10**30")),
    Hostile("lab-odd-variants", "'variants' one of options and summaries", offering(variants="(3,)")),
    Hostile("lab-twice", "two of the same name", returning(f"2 * {offering().rpartition('return ')[2]}")),
    Hostile(
        "lab-changed-after",
        "a name is lower-case words",
        returning("[x]", f"x = {offering().rpartition('return ')[2].strip()}[0]\nobject.__setattr__(x, 'name', 3)"),
    ),
)
WRONG_METADATA = (
    Hostile("lab-no-line", "which is not 'name = module'", entry_points=b"[phframe]\nno equals sign\n"),
    Hostile("lab-no-module", "which is not 'name = module'", entry_points=b"[phframe]\na = b c:::d\n"),
    Hostile("lab-no-name", "no name", metadata=b"Metadata-Version: 2.1\n", known_as="lab_no_name-1.0.dist-info"),
    Hostile("lab-no-metadata", "no name", metadata=b"", known_as="lab_no_metadata-1.0.dist-info"),
    Hostile(
        "lab-control",
        "the name 'a\\x1b[31m'",
        metadata=b"Name: a\x1b[31m\nVersion: 1\n",
        known_as="lab_control-1.0.dist-info",
    ),
    Hostile(
        "lab-impostor",
        "it bears the name of phframe itself",
        metadata=b"Name: PHframe\nVersion: 99\n",
        known_as="lab_impostor-1.0.dist-info",
    ),
    Hostile("lab-pipe", "no regular file", metadata=FIFO, known_as="lab_pipe-1.0.dist-info"),
)
HANGS = (
    Hostile("lab-loops", "gave no answer within", "while True: pass"),
    Hostile("lab-sleeps", "gave no answer within", returning("time.sleep(10**6)")),
    Hostile(
        "lab-catches-all",
        "gave no answer within",
        "import signal\nfor s in (2, 14, 15, 24): signal.signal(s, signal.SIG_IGN)\n"
        "while True:\n    try:\n        while True: pass\n    except BaseException: pass",
    ),
    Hostile("lab-endless-list", "gave no answer within", returning("X()", ENDLESS)),
)
HARMLESS_IN_THE_END = (
    Hostile("lab-good", None),
    Hostile("lab-chats", None, f"print('noise'); os.write(1, b'noise'); os.system('echo noise'){OFFER}"),
    Hostile("lab-chats-much", None, f"os.write(1, b'x' * 10**8); print('x' * 10**7, file=sys.stderr){OFFER}"),
    Hostile("lab-moves", None, f"os.chdir('/'); os.umask(0o777){OFFER}"),
    Hostile("lab-forks", None, f"os.fork(){OFFER}"),
    Hostile("lab-threads", None, f"threading.Thread(target=time.sleep, args=(10**6,)).start(){OFFER}"),
    Hostile("lab-at-exit", None, f"import atexit; atexit.register(time.sleep, 10**6){OFFER}"),
    Hostile("lab-stays", None, f"os._exit = print{OFFER}"),
    Hostile("lab-closes", None, f"os.closerange(0, 256); sys.stdout = sys.stderr = None{OFFER}"),
    Hostile("lab-starts", None, f"import subprocess; subprocess.Popen(['sleep', '600']){OFFER}"),
    Hostile("lab-asks-itself", None, f"from phframe.registry import catalogue; catalogue(){OFFER}"),
    Hostile(
        "lab-requires", None, metadata=b"Name: lab-requires\nVersion: 1.0\nRequires-Dist: ]]\nRequires-Dist: x; ?\n\n"
    ),
    Hostile("lab-latin", None, metadata=b"Name: lab-latin\nVersion: 1.0\nAuthor: \xff\xfe\n\n"),
)
NOT_PLUGINS = (
    Hostile("lab-pipe-points", None, "raise SystemExit", entry_points=FIFO),
    Hostile("lab-large-points", None, "raise SystemExit", entry_points=b"[phframe]\na = b\n" * 10**6),
    Hostile("lab-others", None, "raise SystemExit", entry_points=b"[other\nno equals sign\n\xff"),
)
"""Whose metadata does not say that they have plugins."""
AT_ONCE = (*ENDS_THE_PROCESS, *RAISES, *GREEDY, *ANSWERS_NONSENSE, *WRONG_METADATA, *HARMLESS_IN_THE_END, *NOT_PLUGINS)
