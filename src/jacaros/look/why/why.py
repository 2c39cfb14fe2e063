"""Questions about a run, and their answers from its records. The grammar ignores filler words.

======================================  ==================================================================
``stopped``                             why the robot stopped
``command``, ``command /cmd_vel``       what led to the last command (on a topic)
``operation``, ``operation dock``       what led to the last operation (of a name), and how it ended
``+alarm(_)``, ``-door(open)``          why an event of a belief was handled as it was, or was not handled
``!go(dock)``, ``+!go(_)``, ``-!go(_)``  the same for a goal, or its failure
``?level(X)``, ``+?level(_)``           the same for a test goal, or a question of another agent
``plan @label``, ``plan robot.asl:14``  when a plan was chosen, and why it was not
``belief battery(_)``                   what last changed a belief
``waiting``                             what each intention waits for
``nothing``, ``idle``                   why nothing happens
======================================  ==================================================================
"""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from jacaros.look.records import records
from jacaros.look.records.records import Record, decoded
from jacaros.look.why.about_events import (
    explain_belief,
    explain_deliberation,
    explain_event,
    explain_plan,
    goal_text,
    known_names,
)
from jacaros.look.why.about_motion import explain_command, explain_operation, explain_stop
from jacaros.look.why.about_waiting import explain_idleness, explain_waiting
from jacaros.look.why.chains import is_written
from jacaros.look.why.explanation import Explanation
from jacaros.look.why.past import Past
from jacaros.look.why.patterns import Question, QuestionPattern, literal_at, name_of
from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.texts import help_line, suggestion

MOST_NAMES = 12
"""Number of names that the error for an unknown question lists."""

_PLAN = re.compile(r"@\w+|[\w./\\-]+\.asl:\d+")
_EVENT = re.compile(r"(?:^|(?<=[\s`'\"]))(?:[+\-]?[!?]|[+\-^])(?=~?[a-z_'])")
_LITERAL = re.compile(r"~?[a-z]\w*(?=\()|(?:(?<=belief\s)|(?<=changed\s))~?[a-z]\w*")
_FILLERS = frozenset(
    [
        "why",
        "what",
        "did",
        "do",
        "does",
        "is",
        "was",
        "were",
        "are",
        "the",
        "a",
        "an",
        "it",
        "its",
        "this",
        "that",
        "not",
        "no",
        "there",
        "robot",
        "agent",
        "agents",
        "happen",
        "happens",
        "happened",
        "last",
        "of",
        "on",
        "for",
        "by",
        "from",
        "about",
        "because",
        "led",
        "caused",
        "event",
        "goal",
        "then",
    ]
)
_STARTS_NAME = re.compile(r"[~a-z]\w*$")


class _Kind(NamedTuple):
    """A kind of questions: how to ask, each with its meaning; words that tell it; and what answers."""

    forms: Mapping[str, str]
    words: str
    answer: Callable[[Past, Question], Explanation]


KINDS: Mapping[str, _Kind] = {
    "stopped": _Kind(
        {"stopped": "why the robot stopped"},
        "stop stopped stops stopping stand stands standing still halt halted",
        explain_stop,
    ),
    "command": _Kind(
        {"command [TOPIC]": "what led to the last command"},
        "command commands commanded drive drives driving move moves moving",
        explain_command,
    ),
    "operation": _Kind(
        {"operation [NAME]": "what led to the last operation"},
        "operation operations",
        explain_operation,
    ),
    "event": _Kind(
        {
            "+EVENT, -EVENT": "how an event of a belief was handled, such as `+alarm(_)`",
            "!GOAL, ?TEST, -!GOAL": "the same for a goal, a test goal or a failure",
        },
        "",
        explain_event,
    ),
    "plan": _Kind(
        {"plan @LABEL, plan FILE:LINE": "when a plan was chosen, and why it was not"},
        "",
        explain_plan,
    ),
    "belief": _Kind(
        {"belief BELIEF": "what last changed a belief, such as `battery(_)`"},
        "",
        explain_belief,
    ),
    "waiting": _Kind(
        {"waiting": "what each intention waits for"},
        "wait waits waiting",
        explain_waiting,
    ),
    "idle": _Kind(
        {"nothing": "why nothing happens"},
        "nothing idle stuck hang hangs silent",
        explain_idleness,
    ),
}
"""The kinds of questions."""


def explain(
    happened: Iterable[Record], question: str, at: float | None = None, agent: str = "", robot: str = ""
) -> Explanation:
    """Answer a question about a run.

    Args:
        happened: (t, event, data), as described in docs/reference/recordings.md, the oldest first.
        question: see `KINDS`.
        at: seconds since the run began; later records are ignored. None: the end of the records.
        agent: only goals, plans and beliefs of this agent; empty for all.
        robot: only commands to this robot; empty for all.

    Raises:
        UsageError: the question is not understood, or names an unknown plan or agent.
    """
    past = Past.of(happened, at)
    asked = read_question(question, known_names(past))
    words = question.strip(" ?").split()
    if agent and agent not in past.agents:
        known = ", ".join(past.agents) or "none"
        raise UsageError(f"error: unknown agent: `{agent}`\n  = help: agents until {past.end:.3f} s: {known}")
    agent = agent or next((word for word in words if word in past.agents), "")
    robot = robot or next((word for word in words if word in past.robots), "")
    asked = replace(asked, agent=agent, robot=robot)
    if asked.kind == "name":
        asked = _named(past, asked)
    return KINDS[asked.kind].answer(past, asked)


def _named(past: Past, asked: Question) -> Question:
    """Resolve a lone word: a belief, a goal, an operation, or the label or trigger of a plan.

    Raises:
        UsageError: it is unknown.
    """
    pattern, name = QuestionPattern(asked.about), asked.about
    if any(pattern.fits_literal(data.belief) for _, data in past.beliefs):
        return replace(asked, kind="belief")
    if any(name_of(data.goal) == name for _, data in past.goals):
        return replace(asked, kind="event", about=f"!{name}")
    if any(each.data.operation.partition("(")[0] == name for each in past.operations.values()):
        return replace(asked, kind="operation")
    plans = [plan for _, plan in past.plans(asked.agent)]
    if any(plan.label == name for plan in plans):
        return replace(asked, kind="plan", about=f"@{name}")
    for plan in plans:
        if name_of(plan.trigger) == name:
            return replace(asked, kind="event", about=plan.trigger.partition("(")[0])
    labels = {str(plan.label) for plan in plans if is_written(plan.label)}
    raise unknown_question(asked.written, known_names(past) | labels)


def read_question(written: str, known: Iterable[str] = ()) -> Question:
    """Parse a question. *known* names are suggested if it is not understood.

    Raises:
        UsageError: it is of none of the `KINDS`. The text lists them.
    """
    asked = written.strip(" ?.`'\"\n") if written.strip(" `'\"?") else written
    asked = f"?{asked}" if written.lstrip(" `'\"").startswith("?") else asked
    found = _PLAN.search(asked)
    if found is not None:
        return Question(written, "plan", found[0])
    found = _EVENT.search(asked)
    if found is not None:
        of_plan = "plan" in asked[: found.start()].split()
        event = found[0] + literal_at(asked, found.end())
        QuestionPattern(event)  # raises if it is not a literal
        return Question(written, "plan" if of_plan else "event", event)
    words = asked.split()
    if words[:1] == ["plan"] and len(words) > 1:
        return Question(written, "plan", " ".join(words[1:]))
    if asked.startswith("belief(") and asked.endswith(")"):
        asked = f"belief {asked.removeprefix('belief(')[:-1]}"
    found = _LITERAL.search(asked)
    if found is not None:
        return Question(written, "belief", literal_at(asked, found.start()))
    question = _of_words(written, words)
    if question is None:
        raise unknown_question(written, known)
    return question


def _of_words(written: str, words: list[str]) -> Question | None:
    low = [word.lower().strip(",;:") for word in words]
    for kind, (_, known, _) in KINDS.items():
        at = next((index for index, word in enumerate(low) if word in known.split()), None)
        if at is not None:
            rest = [word for word in words[at + 1 :] if word.lower() not in _FILLERS]
            return Question(written, kind, rest[0] if rest and kind in ("command", "operation") else "")
    left = [word for word in words if word.lower() not in _FILLERS]
    if len(left) == 1 and _STARTS_NAME.match(left[0]):
        return Question(written, "name", left[0])
    return None


def unknown_question(written: str, known: Iterable[str] = ()) -> UsageError:
    """Return the error for a question that is not understood. *known* are names for suggestions."""
    words = {word for kind in KINDS.values() for word in kind.words.split()}
    names = sorted(set(known))
    last = written.strip(" ?`'\"").split()[-1:] or [""]
    help = suggestion(last[0].lstrip("+-!?"), sorted({*words, *names}))
    lines = [f"error: unknown question: `{written}`"]
    if help:
        lines.append(help_line(help))
    if names:
        more = ", ..." if len(names) > MOST_NAMES else ""
        lines.append(
            f"  = help: events, goals and beliefs of this run: {', '.join(names[:MOST_NAMES])}{more}"
        )
    lines.append("  = help: ask one of")
    forms = {form: what for kind in KINDS.values() for form, what in kind.forms.items()}
    width = max(map(len, forms))
    lines += [f"      {form:{width}}  {what}" for form, what in forms.items()]
    return UsageError("\n".join(lines))


# ---- explanations during a run


class Announcer:
    """Explains whenever an event of interest is handled or a goal of interest fails, and at the end of the run events of
    interest that never happened.

    Args:
        so_far: returns the records of the run.
        events: events of interest, such as ``+alarm(_)`` or ``!go(dock)``.
        tell: takes each explanation as text.

    Raises:
        UsageError: one of them is not an event, a goal or a belief.
    """

    def __init__(
        self, so_far: Callable[[], Sequence[Record]], events: Sequence[str], tell: Callable[[str], None]
    ) -> None:
        self._so_far, self._tell = so_far, tell
        self._wanted = {event: QuestionPattern(event) for event in events}
        self._unmet = dict.fromkeys(events)

    def hear(self, t: float, event: str, data: Mapping[str, Any]) -> None:
        """Explain a record, if it is of interest."""
        if event == "ended":
            past = Past.of(self._so_far())
            for asked in self._unmet:
                self._tell(explain_event(past, Question(asked, about=asked)).text())
        elif event in _READERS:
            record = decoded(event, data)
            happened = _READERS[event](record)
            for asked, pattern in self._wanted.items():
                if happened and pattern.fits(happened):
                    explanation = self._explain(asked, t, record)
                    if explanation is not None:
                        self._unmet.pop(asked, None)
                        self._tell(explanation.text())

    def _explain(self, asked: str, t: float, record: records.EventRecord) -> Explanation | None:
        past = Past.of(self._so_far())
        match record:
            case records.DeliberationRecord():
                return explain_deliberation(past, asked, t, record)
            case records.BeliefRecord() if not _has_plan(past, record):
                return explain_event(past, Question(asked, about=asked, agent=record.agent))
            case records.GoalRecord():
                return Explanation(asked, f"{record.agent}: {goal_text(t, record)}", t)
        return None


_READERS: Mapping[str, Callable[[Any], str]] = {
    "deliberation": lambda record: record.trigger,
    "belief": lambda record: f"{record.op}{record.belief}",
    "goal": lambda record: record.goal if record.state == "failed" else "",
}
"""Functions that return the trigger of an explained event, by kind of record."""


def _has_plan(past: Past, change: records.BeliefRecord) -> bool:
    """Return whether a plan may handle a belief change. Then the event is explained when it is handled."""
    name = name_of(change.belief)
    triggers = (plan.trigger for _, plan in past.plans(change.agent))
    return any(each.startswith(change.op) and name_of(each) in (name, "") for each in triggers)
