"""The options of agents in project files."""

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Final

from jacaros.agents.language.diagnostics import Diagnostic, Span
from jacaros.agents.mind.state.budget import Options
from jacaros.files.texts import suggestion

_EVENT: Final = re.compile(r"(\w+::)?~?[a-z]\w*")
_TRUTH: Final = ("true", "false")
_CHOICES: Final[dict[str, tuple[str, ...]]] = {
    "events": ("discard", "requeue", "retrieve"),
    "intBels": ("sameFocus", "newFocus"),
    "verbose": ("0", "1", "2"),
    "synchronised": _TRUTH,
    "tro": _TRUTH,
    "qcache": _TRUTH,
    "qprofiling": _TRUTH,
}
_NUMBERS: Final = (
    "nrcbp",
    "cycles",
    "cycles_sense",
    "cycles_deliberate",
    "cycles_act",
    "rule_depth",
    "goal_depth",
    "belief_limit",
    "event_limit",
    "intention_limit",
    "mailbox_limit",
)
_WITHOUT_EFFECT: Final = {
    "synchronised": "agents always take turns",
    "qcache": "queries use indexes instead",
    "qprofiling": "queries are not measured",
    "mindinspector": "use --view or --record instead",
    "rc": "there is one reasoning cycle",
    "cycles": "agents take turns in one loop",
    "cycles_sense": "every cycle has each stage once",
    "cycles_deliberate": "every cycle has each stage once",
    "cycles_act": "every cycle has each stage once",
}


def check_option(name: str, value: str, span: Span | None) -> Diagnostic | None:
    """Return an error for an invalid option, a warning for one without effect, or None. Custom options are valid."""
    choices = _CHOICES.get(name)
    if choices is not None and value not in choices:
        help = suggestion(value, choices) or None
        return Diagnostic(
            "error", f"expected one of {', '.join(choices)} as `{name}`, found `{value}`", span, help
        )
    if name in _NUMBERS and not (value.isdigit() and int(value) > 0):
        return Diagnostic("error", f"expected a positive integer as `{name}`, found `{value}`", span)
    if name == "urgency" and read_urgencies(value) is None:
        help = 'write events with non-negative integers: `urgency="bumped=10, battery_low=5"`'
        return Diagnostic("error", f"expected urgencies of events, found `{value}`", span, help)
    if name in _WITHOUT_EFFECT:
        why = _WITHOUT_EFFECT[name]
        return Diagnostic("warning", f"the option `{name}` has no effect: {why}", span, code="no-effect")
    return None


_DEFAULTS: Final = Options()


def mind_options(given: Mapping[str, str]) -> Options:
    """Return the options of a mind from those of an agent declaration."""
    options = _DEFAULTS
    if not given:
        return options
    return replace(
        options,
        events=given.get("events", options.events),
        new_focus=given.get("intBels") == "newFocus",
        tail_calls=given.get("tro") != "false",
        verbose=_number(given, "verbose", options.verbose),
        percept_interval=_number(given, "nrcbp", options.percept_interval),
        rule_depth=_number(given, "rule_depth", options.rule_depth),
        goal_depth=_number(given, "goal_depth", options.goal_depth),
        belief_limit=_number(given, "belief_limit", options.belief_limit),
        event_limit=_number(given, "event_limit", options.event_limit),
        intention_limit=_number(given, "intention_limit", options.intention_limit),
        mailbox_limit=_number(given, "mailbox_limit", options.mailbox_limit),
        urgency=read_urgencies(given.get("urgency", "")) or (),
    )


def read_urgencies(text: str) -> tuple[tuple[str, int], ...] | None:
    """Parse the option ``urgency``: ``bumped=10, battery_low=5``. Return None if it is invalid."""
    found = []
    for piece in text.split(",") if text.strip() else ():
        name, separator, number = (part.strip() for part in piece.partition("="))
        if not separator or not _EVENT.fullmatch(name) or not number.isdecimal():
            return None
        found.append((name, int(number)))
    return tuple(found)


def _number(given: Mapping[str, str], name: str, default: int) -> int:
    value = given.get(name, "")
    return int(value) if value.isdigit() else default
