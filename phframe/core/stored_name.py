"""Names that come from files."""

from __future__ import annotations


class StoredName(str):
    """A name that was read from a file. It resolves to what is registered, never to code in a file that it names."""

    __slots__ = ()
