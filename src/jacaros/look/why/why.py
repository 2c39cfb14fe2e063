"""Questions about a run, and their answers from its records.

A question is one of `FORMS`, or a sentence: ``why``, ``when``, ``how often`` or ``did``, and words for what happened. They
are compared with the names of operations, goals, events and beliefs of this run (`jacaros.look.why.deeds`).
"""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from jacaros.look.records import records
from jacaros.look.records.records import Record, decoded
from jacaros.look.why.about_deeds import explain_failure, explain_operation
from jacaros.look.why.about_events import (
    explain_belief,
    explain_deliberation,
    explain_event,
    explain_plan,
)
from jacaros.look.why.about_motion import explain_command, explain_stop
from jacaros.look.why.about_now import explain_now
from jacaros.look.why.deeds import deeds_asked_for
from jacaros.look.why.explanation import Explanation, seconds
from jacaros.look.why.past import Past
from jacaros.look.why.patterns import Question, QuestionPattern, literal_at, name_of
from jacaros.look.why.sentences import LITERAL, SUBJECT_FOLLOWS, WHEN, WHETHER, Answer, explain_sentence
from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.texts import help_line, suggestion

MOST_NAMES = 12
"""Number of names of each kind that the error for an unknown question lists."""

_PLAN = re.compile(r"@\w+|[\w./\\-]+\.asl:\d+")
_EVENT = re.compile(r"(?:^|(?<=[\s`'\"]))(?:[+\-]?[!?]|[+\-^])(?=~?[a-z_'])")


class _Form(NamedTuple):
    """How to ask a question in one word, its meaning, and what answers it."""

    written: str
    meaning: str
    answer: Answer


FORMS: Mapping[str, _Form] = {
    "stopped": _Form("stopped", "why the robot stopped", explain_stop),
    "command": _Form("command [TOPIC]", "what led to the last command", explain_command),
    "operation": _Form("operation [NAME]", "what led to the last operation", explain_operation),
    "event": _Form(
        "+EVENT, !GOAL, ...", "how an event, a goal or its failure (`-!`) was handled", explain_event
    ),
    "plan": _Form("plan @LABEL, plan FILE:LINE", "when a plan was chosen, and why it was not", explain_plan),
    "belief": _Form("belief BELIEF", "what last changed a belief, such as `battery(_)`", explain_belief),
    "waiting": _Form("waiting, nothing", "what each intention waits for", explain_now),
    "failed": _Form("failed", "what failed last, and why", explain_failure),
}
"""The questions with a fixed form."""
_SENTENCES = (
    ("why did it VERB ...", "what led to it, such as `why did it go to the dock`"),
    ("did it VERB ..., did it achieve GOAL", "whether it succeeded"),
    ("when did it ..., how often did it ...", "the times"),
)


def explain(
    happened: Iterable[Record], question: str, at: float | None = None, agent: str = "", robot: str = ""
) -> Explanation:
    """Answer a question about a run.

    Args:
        happened: (t, event, data), as described in docs/reference/recordings.md, the oldest first.
        question: one of `FORMS`, or a sentence.
        at: seconds since the run began; later records are ignored. None: the end of the records.
        agent: only goals, plans and beliefs of this agent; empty for all.
        robot: only commands to this robot; empty for all.

    Raises:
        UsageError: the question is not understood, or names an unknown plan or agent.
    """
    past = Past.of(happened, at)
    words = question.strip(" ?").split()
    if agent and agent not in past.agents:
        known = ", ".join(past.agents) or "none"
        raise UsageError(f"error: unknown agent: `{agent}`\n  = help: agents until {past.end:.3f} s: {known}")
    asked = read_question(question)
    if asked.kind == "sentence":  # elsewhere in a sentence, the name of an agent may be that of a goal
        words = [
            word for last, word in zip(("", *words), words, strict=False) if last.lower() in SUBJECT_FOLLOWS
        ]
    agent = agent or next((word for word in words if word in past.agents), "")
    robot = robot or next((word for word in words if word in past.robots), "")
    asked = replace(asked, agent=agent, robot=robot)
    answer = FORMS[asked.kind].answer if asked.kind in FORMS else explain_sentence
    explanation = answer(past, asked)
    if explanation is None:
        raise unknown_question(past, asked)
    return explanation


def read_question(written: str) -> Question:
    """Return the form of a question and its subject; ``sentence`` for one in other words.

    Raises:
        UsageError: its event is not an event.
    """
    asked = written.strip(" ?.`'\"\n") if written.strip(" `'\"?") else written
    asked = f"?{asked}" if written.lstrip(" `'\"").startswith("?") else asked
    words = asked.split()
    sentence = bool(words) and words[0].lower() in WHETHER | WHEN
    found = _PLAN.search(asked)
    if found is not None:
        return Question(written, "plan", found[0])
    found = _EVENT.search(asked)
    if found is not None and not sentence:
        of_plan = "plan" in asked[: found.start()].split()
        event = found[0] + literal_at(asked, found.end())
        QuestionPattern(event)  # raises if it is not a literal
        return Question(written, "plan" if of_plan else "event", event)
    if words and words != ["plan"] and words[0] in FORMS.keys() - {"event", "belief"}:
        return Question(written, words[0], " ".join(words[1:]))
    if asked.startswith("belief(") and asked.endswith(")"):
        asked = f"belief {asked.removeprefix('belief(')[:-1]}"
    found = LITERAL.search(asked)
    if found is not None and not sentence:
        return Question(written, "belief", literal_at(asked, found.start()))
    return Question(written, "sentence", asked)


def unknown_question(past: Past, asked: Question) -> UsageError:
    """Return the error for a question that is not understood. It lists what this run can be asked about."""
    names: dict[str, dict[str, None]] = {"operation": {}, "goal": {}, "event": {}, "world": {}}
    for each in sorted(deeds_asked_for(past, asked), key=lambda deed: -deed.began):
        names[each.kind].setdefault(name_of(each.text) or each.text)
    known = {name for each in names.values() for name in each}
    last = asked.written.strip(" ?`'\"").split()[-1:] or [""]
    help = suggestion(last[0].lstrip("+-!?"), sorted({*FORMS, *known}))
    lines = [f"error: unknown question: `{asked.written}`"]
    if help:
        lines.append(help_line(help))
    for kind, found in names.items():
        if found:
            more = ", ..." if len(found) > MOST_NAMES else ""
            title = "events in the world" if kind == "world" else f"{kind}s"
            lines.append(
                f"  = help: {title} of this run, newest first: {', '.join([*found][:MOST_NAMES])}{more}"
            )
    forms = [*_SENTENCES, *((form.written, form.meaning) for form in FORMS.values())]
    width = max(len(written) for written, _ in forms)
    lines.append("  = help: ask one of")
    lines += [f"      {written:{width}}  {meaning}" for written, meaning in forms]
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
                return Explanation(
                    asked, f"{record.agent}: {record.goal} failed at {seconds(t)}: {record.why}", t
                )
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
