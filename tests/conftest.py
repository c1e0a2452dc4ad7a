"""Settings of all tests."""

import os
import signal
import tempfile
import threading
from pathlib import Path

import pytest
from hypothesis import Phase, settings

from tests.trials import NOTES, counted

CACHE = tempfile.TemporaryDirectory(prefix="phframe-tests-")  # what plugins answer here is nobody else's
os.environ["PHFRAME_CACHE"] = CACHE.name
os.environ.setdefault(NOTES, str(Path(CACHE.name, "trials")))  # the processes that share the tests take it over

settings.register_profile("phframe", deadline=None, print_blob=True)  # a busy machine is no failure
settings.register_profile("same-every-time", settings.get_profile("phframe"), derandomize=True)
settings.register_profile(  # where it is enough to know that something fails
    "mutants", settings.get_profile("same-every-time"), phases=[Phase.explicit, Phase.generate]
)
settings.load_profile(os.environ.get("PHFRAME_TEST_PROFILE", "phframe"))

if threading.current_thread() is threading.main_thread():  # a shell starts jobs in the background with Ctrl-C ignored
    signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Print what the suites of fault injection tried."""
    notes = Path(os.environ[NOTES])
    if notes.exists():
        terminalreporter.section("tried")
        for kind, number in sorted(counted(notes).items()):
            terminalreporter.write_line(f"{number:8,} {kind}")
