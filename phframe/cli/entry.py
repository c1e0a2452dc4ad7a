"""Where the command ``phframe`` begins and ends: being told to end is answered with a line and an exit code in between.

Only the start of the interpreter, before this, and what it takes apart at the very end are not in between; at the end the
signals are ignored.
"""

from __future__ import annotations

import os
import sys

from phframe.cli.interrupt import EndSignals, dependable_interrupts

PATIENCE = 0.5
"""From one signal until the next that interrupts once more: what is being saved has so long, and a key held counts once (s)."""
_INTERRUPTED = 130  # ExitCode.INTERRUPTED, which is not imported yet


def main() -> None:
    """Entry point of the command; ends the process. Being told to terminate is like Ctrl-C: what was recorded is kept."""
    signals = EndSignals(PATIENCE)
    try:
        try:
            signals.install()
            with dependable_interrupts(signals.again):
                from phframe.cli.main import main as run

                run()
        finally:
            signals.at_exit(_leave)
    except KeyboardInterrupt:
        _say_interrupted()
        sys.exit(_INTERRUPTED)


def _leave() -> None:
    """End a process whose work is done and that does not come to its end, as for a thread that a plugin has left."""
    _say_interrupted()
    os._exit(_INTERRUPTED)


def _say_interrupted() -> None:
    """As ``console.note`` does, which may not be there."""
    os.write(2, b"interrupted\n")
