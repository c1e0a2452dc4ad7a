"""Settings of all tests."""

import os
import signal
import tempfile
import threading

from hypothesis import settings

CACHE = tempfile.TemporaryDirectory(prefix="phframe-tests-")  # what plugins answer here is nobody else's
os.environ["PHFRAME_CACHE"] = CACHE.name

settings.register_profile("phframe", deadline=None, print_blob=True)  # a busy machine is no failure
settings.register_profile("same-every-time", settings.get_profile("phframe"), derandomize=True)
settings.load_profile(os.environ.get("PHFRAME_TEST_PROFILE", "phframe"))

if threading.current_thread() is threading.main_thread():  # a shell starts jobs in the background with Ctrl-C ignored
    signal.signal(signal.SIGINT, signal.default_int_handler)
