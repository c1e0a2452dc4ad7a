"""Errors read well, derive from one root and survive the way between processes."""

from __future__ import annotations

import pickle
from typing import Annotated

import pytest
from pydantic import Field

from phframe.core import (
    ArmError,
    InputError,
    NotInstalledError,
    OptionError,
    Options,
    PhframeError,
    SceneError,
    UnknownNameError,
    errors,
)
from phframe.registry import Kind
from phframe.testing import ConformanceError, Failure, Fault

EXAMPLES = [
    SceneError(["a is bad", "b is worse"], "shelf.yaml"),
    SceneError("alone"),
    UnknownNameError("planner", "phya", ["phia", "ooa"], "Install more."),
    NotInstalledError("backend 'mujoco'", "mujoco", "pip install 'phframe[mujoco]'"),
    ConformanceError("Mine", [Failure("a_check", "the promise", (Fault("1", "2"),))]),
    InputError("plain"),
]


@pytest.mark.parametrize("error", EXAMPLES, ids=lambda error: type(error).__name__)
def test_errors_survive_pickling(error: PhframeError) -> None:
    copy = pickle.loads(pickle.dumps(error))
    assert type(copy) is type(error)
    assert str(copy) == str(error)
    assert vars(copy) == vars(error)


def test_every_error_has_the_one_root() -> None:
    found = [value for value in vars(errors).values() if isinstance(value, type) and issubclass(value, Exception)]
    assert len(found) >= 10
    assert all(issubclass(kind, PhframeError) for kind in found)


@pytest.mark.parametrize(
    ("error", "text"),
    [
        (EXAMPLES[0], "shelf.yaml: a is bad; b is worse"),
        (EXAMPLES[1], "alone"),
        (EXAMPLES[2], "no planner named 'phya'. Did you mean 'phia'? There is: ooa, phia. Install more."),
        (UnknownNameError("arm", "zzz", ["planar"]), "no arm named 'zzz'. There is: planar."),
        (
            UnknownNameError("kind", "plannr", Kind),
            f"no kind named 'plannr'. Did you mean 'planner'? There is: {', '.join(sorted(Kind))}.",
        ),
        (UnknownNameError("arm", "zzz", []), "no arm named 'zzz'. There is no arm at all."),
        (EXAMPLES[3], "backend 'mujoco' needs mujoco, which is not installed. pip install 'phframe[mujoco]'"),
    ],
)
def test_messages(error: PhframeError, text: str) -> None:
    assert str(error) == text


class Settings(Options):
    margin: Annotated[float, Field(gt=0.0)] = 0.015
    tries: int = 3


def test_options_are_parsed_from_text() -> None:
    assert Settings.parse({"margin": "0.5", "tries": "4"}, "planner phia") == Settings(margin=0.5, tries=4)
    assert Settings.parse({}, "planner phia") == Settings()


@pytest.mark.parametrize(
    ("given", "text"),
    [
        ({"margn": 1}, "planner phia has no option 'margn'. Did you mean 'margin'? There is: margin, tries."),
        ({"tries": "many"}, "planner phia: option 'tries' is 'many': input should be a valid integer"),
        ({"margin": -1}, "planner phia: option 'margin' is -1: input should be greater than 0"),
        ({"margin": "nan"}, "planner phia: option 'margin' is 'nan': input should be a finite number"),
    ],
)
def test_bad_options_are_told(given: dict[str, object], text: str) -> None:
    with pytest.raises(OptionError) as caught:
        Settings.parse(given, "planner phia")
    assert str(caught.value).startswith(text)


def test_arm_errors_are_input_errors() -> None:
    assert issubclass(ArmError, InputError)
