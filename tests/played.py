"""Tests whose body is a coroutine that something plays: a lab, a graph, a virtual clock."""

import inspect
from collections.abc import Callable
from functools import partial
from typing import Any


def played(play: Callable[..., Any], *arguments: Any, **options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Make a test of a coroutine function: ``play(scene, *arguments, **options)`` calls it.

    What ``play`` passes to the scene is its first parameter; the others are fixtures, as for any test.
    """

    def as_test(scene: Callable[..., Any]) -> Callable[..., None]:
        parameters = list(inspect.signature(scene).parameters.values())

        def test(**fixtures: Any) -> None:
            # Worlds and files come before the scene where a lab takes them first.
            play(*arguments, partial(scene, **fixtures), **options)

        test.__name__, test.__doc__, test.__module__ = scene.__name__, scene.__doc__, scene.__module__
        test.__signature__ = inspect.Signature(parameters[1:])  # type: ignore[attr-defined]
        return test

    return as_test
