"""What is read of a distribution's metadata is what importlib.metadata, which reads all of it, has."""

from __future__ import annotations

from importlib import metadata

import pytest

from phframe.core.metadata_fields import fields, requirements_of, version_of

INSTALLED = sorted(
    {each.name for each in metadata.distributions() if each.name and list(metadata.distributions(name=each.name))}
)
"""Some may be hidden: they are listed, and not found by their names."""


@pytest.mark.parametrize("name", INSTALLED)
def test_of_all_that_is_installed_version_and_requirements_are_found(name: str) -> None:
    assert version_of(name) == metadata.version(name)
    assert requirements_of(name) == list(metadata.requires(name) or ())


def test_the_description_is_not_read() -> None:
    assert list(fields("Name: lab\nVERSION:  1.0 \n\nVersion: 2.0\n")) == [("name", "lab"), ("version", "1.0")]


def test_what_is_not_installed_is_told() -> None:
    for ask in (version_of, requirements_of):
        with pytest.raises(metadata.PackageNotFoundError):
            ask("no-such-distribution")
