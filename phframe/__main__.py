"""``python -m phframe`` is the command ``phframe``: modules that lie about in the working directory are no part of it."""

import os
import sys

if __name__ == "__main__":
    home = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))  # noqa: PTH100, PTH120 - nothing is imported yet
    if sys.flags.safe_path:
        pass
    elif sys.path[0] == home:
        os.environ.setdefault(
            "PYTHONSAFEPATH", ""
        )  # a source tree, perhaps not installed: processes that are started need it
    else:
        del sys.path[0]

    from phframe.cli.entry import main

    main()
