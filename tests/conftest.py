"""Settings of all tests."""

import os

from hypothesis import settings

settings.register_profile("phframe", deadline=None, print_blob=True)  # a busy machine is no failure
settings.register_profile("same-every-time", settings.get_profile("phframe"), derandomize=True)
settings.load_profile(os.environ.get("PHFRAME_TEST_PROFILE", "phframe"))
