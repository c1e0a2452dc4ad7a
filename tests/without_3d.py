"""Once this is imported, the libraries for 3D are as if they were not installed: `pytest -p tests.without_3d`.

So the tests of the core prove that it needs none of them, whatever is installed beside it.
"""

from tests.absence import DISTRIBUTIONS, hide

hide(tuple(DISTRIBUTIONS))
