"""Terms, values of the environment and ROS messages in records: short, with the names that users gave."""

import math
import re
from collections.abc import Iterable, Iterator
from typing import Any

from jacaros.agents.mind.state.triggers import Goal, literal_of
from jacaros.agents.terms.operators import ArithmeticFault
from jacaros.agents.terms.substitution import is_flat
from jacaros.agents.terms.text import excerpt, text
from jacaros.agents.terms.values import Term
from jacaros.artifacts.env.operation import OperationRequest
from jacaros.artifacts.env.values import Out
from jacaros.artifacts.env.values import text as value_text
from jacaros.robots.ros.message import field_names

LONGEST = 300
"""Maximum number of characters of a recorded term."""
_UNNAMED = re.compile(r'"(?:[^"\\]|\\.)*"|\b_\w+')


def shown(term: Term) -> str:
    """Return a term as text: the beginning of a large one, and ``_`` for unnamed variables."""
    if is_flat(term):
        return cut(text(term))
    try:
        return cut(named(text(excerpt(term))))
    except (ArithmeticFault, RecursionError):
        return "..."


def shown_event(goal: Goal) -> str:
    """Return a goal or event with its operator, such as ``+!go(dock)`` or ``+battery(12)``."""
    kind = goal[0]
    return f"{kind.operator}{kind.kind}{shown(literal_of(goal, ()))}"


def named(told: str) -> str:
    """Replace unnamed variables such as ``_22`` with ``_``."""
    return _UNNAMED.sub(_name, told) if "_" in told else told


def _name(found: re.Match[str]) -> str:
    word = found.group()
    return word if word[0] == '"' else "_"


def cut(told: str, longest: int = LONGEST) -> str:
    """Return the beginning of a text that is longer than *longest* characters."""
    return told if len(told) <= longest else f"{told[: longest - 3]}..."


# ---- values and messages

LONGEST_VALUE = 200
"""Maximum number of characters of a recorded value or message."""
LONGEST_TEXT = 1000
"""Maximum number of characters of a recorded string: a question to a person must be readable."""
_FIELDS = 12
"""Maximum number of fields of a message."""
_LARGEST = 10**15


def limited(words: str) -> str:
    """Return *words*, cut to `LONGEST_VALUE` characters."""
    return cut(words, LONGEST_VALUE)


def json_value(value: object) -> object:
    """Return a plain value of the environment as JSON data: numbers, Booleans, strings and short lists; others as text."""
    kind = type(value)
    if kind is float:
        return value if math.isfinite(value) else str(value)  # type: ignore[arg-type]
    if value is None or kind is bool:
        return value
    if kind is int and -_LARGEST < value < _LARGEST:  # type: ignore[operator]
        return value
    words = _value_text(value)
    if kind is list and len(words) <= LONGEST_VALUE:
        return json_values(value)  # type: ignore[arg-type]
    return words[:LONGEST_TEXT] if isinstance(value, str) else limited(words)


def json_values(values: Iterable[object]) -> list[object]:
    """Return plain values as JSON data."""
    return [json_value(value) for value in values]


def call_text(name: str, arguments: Iterable[object]) -> str:
    """Return an operation or a signal with its arguments as agents write it. Output parameters are ``_``."""
    written = ",".join("_" if isinstance(each, Out) else _value_text(each, quoted=True) for each in arguments)
    return limited(f"{name}({written})" if written else name)


def request_text(request: OperationRequest) -> str:
    """Return a request to an artifact as agents write it."""
    return call_text(request.operation, request.arguments)


def output_texts(request: OperationRequest) -> list[str | None]:
    """Return the values of the output parameters of an operation as agents write them; None for unset ones."""
    outputs = (each for each in request.arguments if isinstance(each, Out))
    return [limited(_value_text(each.value, quoted=True)) if each.is_set else None for each in outputs]


def _value_text(value: object, quoted: bool = False) -> str:
    try:
        return value_text(value, quoted)
    except Exception:  # an error in a user's __str__ must not make a record fail
        return type(value).__name__


def message_text(message: Any, effect: Iterable[object] = ()) -> str:
    """Return the numbers, strings and Booleans of a message that are not 0 or empty, by field.

    Args:
        message: the message.
        effect: values that came of it. Fields that they may have come from are first, and those that are NaN last.
    """
    values = [each for each in effect if each not in (0, "", None)]
    fields = sorted(_fields(message, "", 4), key=lambda each: _importance(each[1], values))
    found = [text for text, _ in fields]
    if len(found) > _FIELDS:
        found[_FIELDS:] = ["..."]
    return limited(", ".join(found))


def _fields(message: Any, path: str, depth: int) -> Iterator[tuple[str, object]]:
    """Return the fields of a message as text, each with its value."""
    for name in field_names(message) or ():
        value = getattr(message, name)
        if isinstance(value, float):
            if value:
                yield f"{path}{name}={value:.4g}", value
        elif isinstance(value, int | str):
            if value:
                yield f"{path}{name}={limited(str(value))}", value
        elif hasattr(value, "__len__"):
            if len(value) and name != "covariance":
                yield f"{path}{name}=[{len(value)} values]", None
        elif name != "header" and depth:
            yield from _fields(value, f"{path}{name}.", depth - 1)


def _importance(value: object, effect: list[object]) -> int:
    """Return 0 for a value that the effect may have come from, as it is or in other units, 2 for NaN, otherwise 1."""
    if isinstance(value, float) and math.isnan(value):
        return 2
    return 0 if any(_may_be(value, each) for each in effect) else 1


def _may_be(value: object, effect: object) -> bool:
    if isinstance(value, str | bool) or not isinstance(effect, int | float):
        return value == effect
    if not isinstance(value, int | float) or not math.isfinite(value):
        return False
    rounding = 1.0 if isinstance(effect, int) else max(0.006, 0.001 * abs(effect))
    return any(abs(value * scale - effect) < rounding for scale in (1.0, 100.0, 180 / math.pi))
