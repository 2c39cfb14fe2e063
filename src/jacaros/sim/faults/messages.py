"""Effects of faults on messages: dead, frozen or NaN sensors, and lost, delayed or duplicated messages."""

import copy
import math
import random
from collections.abc import Callable, Iterable, Sequence
from dataclasses import fields, is_dataclass
from typing import Any

from jacaros.sim.faults.description import Fault

Effect = Callable[[Any], Sequence[tuple[float, Any]]]
"""Takes a message and returns the messages delivered instead, each with its delay in seconds; empty if it is lost."""

_KEPT = frozenset(
    {"header", "angle_min", "angle_max", "angle_increment", "range_min", "range_max", "scan_time"}
)
"""Fields that describe a sensor and are not measurements."""


def effect_of(fault: Fault, seed: int) -> Effect:
    """Return the effect of a fault on the messages of its topic."""
    chance = random.Random(f"{seed}/{fault.name}/messages")
    if fault.kind == "dead":
        return lambda message: ()
    if fault.kind == "frozen":
        return _Frozen().replace
    if fault.kind == "nan":
        return lambda message: ((0.0, _without_numbers(copy.deepcopy(message))),)
    if fault.kind == "lost":
        return lambda message: () if chance.random() < fault.share else ((0.0, message),)
    if fault.kind == "delayed":
        return lambda message: ((fault.seconds + fault.jitter * chance.random(), message),)
    return lambda message: [(0.0, message)] * fault.copies


class _Frozen:
    """Repeats the first message, with the stamps of the replaced messages."""

    def __init__(self) -> None:
        self._first: Any = None

    def replace(self, message: Any) -> Sequence[tuple[float, Any]]:
        if self._first is None:
            self._first = copy.deepcopy(message)
        repeated = copy.deepcopy(self._first)
        if hasattr(message, "header"):
            repeated.header.stamp = message.header.stamp
        return ((0.0, repeated),)


def _without_numbers(message: Any) -> Any:
    """Set all floating-point measurements to NaN."""
    for name in _fields(message):
        value = getattr(message, name)
        if name in _KEPT or "covariance" in name:
            continue
        if isinstance(value, float):
            setattr(message, name, math.nan)
        elif _fields(value):
            _without_numbers(value)
        elif not isinstance(value, str | bytes) and isinstance(value, Iterable):
            # For arrays, the items as Python values.
            items = list(getattr(value, "tolist", value.__iter__)())
            if items and all(isinstance(item, float) for item in items):
                setattr(message, name, [math.nan] * len(items))
    return message


def _fields(value: Any) -> list[str]:
    """Return the field names of a message of any middleware; an empty list for other values."""
    if is_dataclass(value):
        return [field.name for field in fields(value)]
    return [
        slot.removeprefix("_") for slot in getattr(type(value), "__slots__", ()) if slot != "_check_fields"
    ]
