"""``python -m phframe`` is the command ``phframe``."""

from phframe.cli.main import main

if __name__ == "__main__":
    main()
