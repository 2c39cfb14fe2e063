"""The arithmetic functions, which the parser tells from internal actions by name and number of arguments."""

import math
from collections.abc import Mapping
from typing import Final

ARITIES: Final[dict[str, tuple[int, float]]] = {
    **dict.fromkeys(
        (
            "math.abs",
            "math.acos",
            "math.asin",
            "math.atan",
            "math.ceil",
            "math.cos",
            "math.floor",
            "math.log",
        ),
        (1, 1),
    ),
    **dict.fromkeys(("math.round", "math.sin", "math.sqrt", "math.tan"), (1, 1)),
    **dict.fromkeys(("math.average", "math.max", "math.mean", "math.median", "math.min"), (1, math.inf)),
    **dict.fromkeys(("math.std_dev", "math.sum"), (1, math.inf)),
    **dict.fromkeys(("math.e", "math.pi", "system.time"), (0, 0)),
    "math.random": (0, 1),
    ".length": (1, 1),
    ".count": (1, 1),
}
"""Fewest and most arguments of each function of the language."""


def is_function(name: str, arity: int, registered: dict[str, int]) -> bool:
    """Whether *name* with *arity* arguments is a function of the language or one of the *registered* ones."""
    limits = ARITIES.get(name)
    if limits is not None and limits[0] <= arity <= limits[1]:
        return True
    return registered.get(name) == arity


class FunctionNames(dict[str, int]):
    """The functions that a running program has registered, with their numbers of arguments.

    Attributes:
        known: those of the project, with their least and greatest numbers of arguments.
    """

    def __init__(
        self, registered: Mapping[str, int], known: Mapping[str, tuple[int, int | None]] | None = None
    ) -> None:
        super().__init__(registered)
        self.known = {} if known is None else known
