"""The options of agents in project files."""

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, Final, NamedTuple

from jacaros.agents.language.diagnostics import Diagnostic, Span
from jacaros.agents.mind.state.budget import Options
from jacaros.runtime.files.texts import suggestion

_EVENT: Final = re.compile(r"(\w+::)?~?[a-z]\w*")
_DEFAULTS: Final = Options()


def read_urgencies(text: str) -> tuple[tuple[str, int], ...] | None:
    """Parse the option ``urgency``: ``bumped=10, battery_low=5``. Return None if it is invalid."""
    found = []
    for piece in text.split(",") if text.strip() else ():
        name, separator, number = (part.strip() for part in piece.partition("="))
        if not separator or not _EVENT.fullmatch(name) or not number.isdecimal():
            return None
        found.append((name, int(number)))
    return tuple(found)


class _Option(NamedTuple):
    """An option.

    Attributes:
        choices: its values; without any, it is a number.
        field: the field of `Options` that it sets.
        read: from its text to the value of the field.
        why: why it has no effect.
    """

    choices: tuple[str, ...] = ()
    field: str = ""
    read: Callable[[str], object] = int
    why: str = ""


_TRUTH: Final = ("true", "false")
_LIMITS: Final = (
    "rule_depth",
    "goal_depth",
    "belief_limit",
    "event_limit",
    "intention_limit",
    "mailbox_limit",
)
_STAGES: Final = "every cycle has each stage once"
_OPTIONS: Final = {
    "events": _Option(("discard", "requeue", "retrieve"), "events", str),
    "intBels": _Option(("sameFocus", "newFocus"), "new_focus", "newFocus".__eq__),
    "verbose": _Option(("0", "1", "2"), "verbose"),
    "tro": _Option(_TRUTH, "tail_calls", "false".__ne__),
    "synchronised": _Option(_TRUTH, why="agents always take turns"),
    "qcache": _Option(_TRUTH, why="queries use indexes instead"),
    "qprofiling": _Option(_TRUTH, why="queries are not measured"),
    "nrcbp": _Option(field="percept_interval"),
    "cycles": _Option(why="agents take turns in one loop"),
    **dict.fromkeys(("cycles_sense", "cycles_deliberate", "cycles_act"), _Option(why=_STAGES)),
    **{name: _Option(field=name) for name in _LIMITS},
}
_WITHOUT_EFFECT: Final = {
    "mindinspector": "use --view or --record instead",
    "rc": "there is one reasoning cycle",
}


def check_option(name: str, value: str, span: Span | None) -> Diagnostic | None:
    """Return an error for an invalid option, a warning for one without effect, or None. Custom options are valid."""
    option = _OPTIONS.get(name)
    expected, help = "", None
    if option is not None and option.choices and value not in option.choices:
        expected, help = f"one of {', '.join(option.choices)} as `{name}`", suggestion(value, option.choices)
    elif option is not None and not option.choices and not (value.isdigit() and int(value) > 0):
        expected = f"a positive integer as `{name}`"
    elif name == "urgency" and read_urgencies(value) is None:
        expected = "urgencies of events"
        help = 'write events with non-negative integers: `urgency="bumped=10, battery_low=5"`'
    if expected:
        return Diagnostic("error", f"expected {expected}, found `{value}`", span, help or None)
    why = _WITHOUT_EFFECT.get(name) or (option.why if option is not None else "")
    if why:
        return Diagnostic("warning", f"the option `{name}` has no effect: {why}", span, code="no-effect")
    return None


def mind_options(given: Mapping[str, str]) -> Options:
    """Return the options of a mind from those of an agent declaration. Invalid values are ignored."""
    if not given:
        return _DEFAULTS
    read: dict[str, Any] = {"urgency": read_urgencies(given.get("urgency", "")) or ()}
    for name, value in given.items():
        option = _OPTIONS.get(name)
        if option is not None and option.field and (option.read is not int or value.isdigit()):
            read[option.field] = option.read(value)
    return replace(_DEFAULTS, **read)
