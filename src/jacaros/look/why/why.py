"""Questions about a run, and their answers from its records.

A question has one of `FORMS`, or is a sentence: ``why``, ``when``, ``how often``, ``did`` or ``is``, and words for what
happened. They are compared with the names of operations, goals, events and beliefs of this run (`jacaros.look.why.deeds`).
"""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from jacaros.look.records import records
from jacaros.look.records.records import Record, decoded
from jacaros.look.why import deeds
from jacaros.look.why.about_deeds import explain_failure, explain_outcome, explain_when, explain_why
from jacaros.look.why.about_events import CHOSEN, explain_belief, explain_event, explain_plan, plan_about
from jacaros.look.why.about_motion import explain_command, explain_drive, explain_stop, explain_turn
from jacaros.look.why.about_now import explain_now
from jacaros.look.why.chains import with_values
from jacaros.look.why.explanation import Explanation, seconds
from jacaros.look.why.past import OPEN, Deed, Happened, Past
from jacaros.look.why.patterns import LITERAL, Question, QuestionPattern, literal_at, name_of
from jacaros.robots.world.data.ground_truth import FIELDS
from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.texts import help_line, suggestion

Answer = Callable[[Past, Question], Explanation | None]
_Verbs = Sequence[tuple[frozenset[str], Answer]]

MOST_NAMES = 12
"""Number of names of each kind that the error for an unknown question lists."""

FORMS: Mapping[str, str] = {
    "why did it VERB ...": "what led to it, such as `why did it go to the dock`",
    "did it VERB ..., did it achieve GOAL": "whether it succeeded",
    "when did it ..., how often did it ...": "the times",
    "stopped": "why the robot stopped",
    "waiting, nothing": "what each intention waits for",
    "failed": "what failed last, and why",
    "operation [NAME]": "what led to the last operation",
    "command [TOPIC]": "what led to the last command",
    "+EVENT, !GOAL, ...": "how an event, a goal or its failure (`-!`) was handled",
    "plan @LABEL, plan FILE:LINE": "when a plan was chosen, and why it was not",
    "belief BELIEF": "what last changed a belief, such as `battery(_)`",
}
"""How to ask, and what is answered."""

_WORD = re.compile(r"[A-Za-z]+'[a-z]+|\w+")
_NOW = deeds.words_of("is are am")
_WHETHER = _NOW | deeds.words_of("did does do has have had was were can could will would")
_WHEN = deeds.words_of("when where how")
_BEFORE_SUBJECT = _WHETHER | {"", "agent", "robot", "for"}
"""Words before the name of an agent, such as `did`; at the beginning, an empty one. Elsewhere, it may be that of a goal."""
_NEGATIONS = deeds.words_of("not never no")
_FILLERS = _WHETHER | _WHEN | _NEGATIONS
_FILLERS |= deeds.words_of(
    "what which who why a an the this that there then here now its it i me my you we us they their robot robots agent "
    "agents run to into in on of off from for at by with about around up and so because get got something anything someone "
    "everything need needed want wanted try tried last first again often time times all happen happens happened led make "
    "made caused changed"
)
"""Words that say nothing about what happened."""
_KINDS = deeds.words_of("operation goal event")
_OUTCOMES = deeds.ENDING | deeds.FAILING | deeds.STOPPING | deeds.RESTING | _KINDS | {"plan"}
"""Words about what else the question names."""
_SUBJECTS: _Verbs = (
    (deeds.STOPPING, explain_stop),
    (deeds.RESTING, explain_now),
    (deeds.FAILING, explain_failure),
    (deeds.ENDING, explain_now),
)
"""Verbs that need no object, and what answers them."""
_MOTIONS: _Verbs = ((deeds.TURNING, explain_turn), (deeds.MOVING, explain_drive))
"""Verbs that the commands to the wheels explain if the program has no name for them."""


def explain(
    happened: Iterable[Happened], question: str, at: float | None = None, agent: str = "", robot: str = ""
) -> Explanation:
    """Answer a question about a run.

    Args:
        happened: (t, event, data), as described in docs/reference/recordings.md, the oldest first.
        question: one of `FORMS`, or another sentence.
        at: seconds since the run began; later records are ignored. None: the end of the records.
        agent: only goals, plans and beliefs of this agent; empty for all.
        robot: only commands to this robot; empty for all.

    Raises:
        UsageError: the question is not understood, or names an unknown plan or agent.
    """
    past = Past.of(happened, at)
    if agent and agent not in past.agents:
        known = ", ".join(past.agents) or "none"
        raise UsageError(f"error: unknown agent: `{agent}`\n  = help: agents until {past.end:.3f} s: {known}")
    asked = Question.read(question, (_WHETHER | _WHEN).__contains__)
    words, about = question.strip(" ?").split(), asked.about
    if asked.kind == "sentence":
        subjects, others = [""], [""]
        for last, word in zip(("", *about.split()), about.split(), strict=False):
            is_subject = word in {*past.agents, *past.robots} and last.lower() in _BEFORE_SUBJECT
            (subjects if is_subject else others).append(word)
        words, about = subjects, " ".join(others).strip()
    agent = agent or next((word for word in words if word in past.agents), "")
    robot = robot or next((word for word in words if word in past.robots), "")
    asked = replace(asked, about=about, agent=agent, robot=robot)
    explanation = _ANSWERS[asked.kind](past, asked)
    if explanation is None:
        raise unknown_question(past, asked)
    return explanation


def unknown_question(past: Past, asked: Question) -> UsageError:
    """Return the error for a question that is not understood. It lists what this run can be asked about."""
    names: dict[str, dict[str, None]] = {"operation": {}, "goal": {}, "event": {}, "world": {}}
    for each in sorted(deeds.deeds_asked_for(past, asked), key=lambda deed: -deed.began):
        names[each.kind].setdefault(name_of(each.text) or each.text)
    known = {name for each in (FORMS, *names.values()) for name in each}
    last = asked.written.strip(" ?`'\"").split()[-1:] or [""]
    help = suggestion(last[0].lstrip("+-!?"), sorted(known))
    lines = [f"error: unknown question: `{asked.written}`", *([help_line(help)] if help else ())]
    for kind, found in names.items():
        if found:
            listed = ", ".join([*found][:MOST_NAMES]) + (", ..." if len(found) > MOST_NAMES else "")
            title = "events in the world" if kind == "world" else f"{kind}s"
            lines.append(f"  = help: {title} of this run, newest first: {listed}")
    width = max(map(len, FORMS))
    lines += [
        "  = help: ask one of",
        *(f"      {form:{width}}  {meaning}" for form, meaning in FORMS.items()),
    ]
    return UsageError("\n".join(lines))


# ---- sentences


class _Sentence(NamedTuple):
    """The parts of a question: its words in lower case, the first one, and the stems of those that say what happened."""

    said: list[str]
    first: str
    words: list[str]

    @classmethod
    def of(cls, text: str) -> "_Sentence":
        heard = _WORD.findall(text)
        said = [word.lower() for word in heard]
        meant = (word for word in heard if word.lower() not in _FILLERS and "'" not in word)
        return cls(said, said[0] if said else "", [part for word in meant for part in deeds.stems(word)])

    @property
    def is_negated(self) -> bool:
        return any(word in _NEGATIONS or word.endswith("n't") for word in self.said)

    def is_only(self, verbs: frozenset[str]) -> bool:
        return bool(self.words) and verbs.issuperset(self.words)


def explain_sentence(past: Past, asked: Question) -> Explanation | None:
    """Explain what the words of a question describe; None if nothing of this run fits them."""
    sentence = _Sentence.of(asked.about)
    if any(name_of(data.belief) == asked.about for _, data in past.beliefs):
        return explain_belief(past, asked)
    for verbs, answer in _SUBJECTS:
        if not verbs.isdisjoint(sentence.words) and sentence.is_only(verbs | deeds.MOVING):
            return answer(past, asked)
    motions = (answer for verbs, answer in _MOTIONS if sentence.is_only(verbs - deeds.ARRIVING))
    return (
        (_of_beliefs(past, asked, sentence) if sentence.first in _NOW else None)
        or _of_deeds(past, asked, sentence)
        or next((answer(past, asked) for answer in motions), None)
        or _of_beliefs(past, asked, sentence)
        or _of_nothing(past, asked, sentence)
    )


def _of_deeds(past: Past, asked: Question, sentence: _Sentence) -> Explanation | None:
    """Explain the deeds that a sentence describes, or how they ended; None if nothing fits."""
    kinds = _KINDS.intersection(sentence.said)
    all_found = [each for each in deeds.deeds_asked_for(past, asked) if not kinds or each.kind in kinds]
    words = [word for word in sentence.words if word not in kinds]
    objects = [word for word in words if word not in _OUTCOMES]
    literal, ends = LITERAL.search(asked.about), False
    if literal is not None:
        pattern = QuestionPattern(literal_at(asked.about, literal.start()))
        found = [each for each in all_found if pattern.fits_literal(each.text)]
    elif kinds and not words:
        found = all_found[-1:]
    else:
        found = deeds.described(past, words, all_found)
        if not found and objects:
            found, ends = deeds.described(past, objects, all_found), True
        if deeds.ARRIVING.issuperset(objects):  # without a destination, no drive is meant
            found = [each for each in found if {*words} <= {*deeds.stems(each.text)}]
    if not found:
        return None
    if sentence.first in _WHEN:
        return explain_when(past, asked, found)
    last = found[-1]
    if sentence.first in _WHETHER or ends or sentence.is_negated:
        # Whether it did `dock` is not answered by yes or no if all that is known is the end of `find_dock`; and whether it
        # is docked, not by the end of anything.
        named = literal is not None or deeds.is_named(last, words)
        verdict = sentence.first in _WHETHER and named and (sentence.first not in _NOW or last.state in OPEN)
        ask = sentence.first if verdict else "why not" if sentence.is_negated else "why"
        return explain_outcome(past, asked, found, ask)
    if last.kind == "event":
        return explain_event(past, replace(asked, about=last.text))
    return explain_why(past, asked, found)


def _of_beliefs(past: Past, asked: Question, sentence: _Sentence) -> Explanation | None:
    """Explain the beliefs that a sentence describes, or those from which a rule concludes it; None if nothing fits."""
    held, words = deeds.beliefs(past, asked.agent), sentence.words
    if sentence.first in _WHETHER:  # whether it is docked does not follow from where it believes a dock to be
        held = [each for each in held if "source(percept)" in each.text or deeds.is_named(each, words)]
    found = deeds.described(past, words, held)
    if found and sentence.first not in _WHEN and deeds.MOVING.isdisjoint(words):
        return (explain_outcome if sentence.first in _WHETHER else explain_why)(past, asked, found)
    for agent, rules in past.rules.items() if sentence.first in _NOW else ():
        heads = (rule.partition(":-")[0].strip() for rule in rules)
        name = next((each for each in heads if {*deeds.stems(name_of(each))} == {*words}), None)
        if name is not None and asked.agent in ("", agent):
            answer = f"a rule of {agent} decides {with_values(past, agent, name, past.end)}"
            return Explanation(asked.written, answer, past.end)
    return None


def _of_nothing(past: Past, asked: Question, sentence: _Sentence) -> Explanation | None:
    """Explain what did not happen: a plan, or an event of the world."""
    denied = "no: " if sentence.first in _WHETHER else ""
    plan = plan_about(past, sentence.words, asked.agent) if sentence.first not in _NOW else None
    if plan is not None:
        explanation = explain_plan(past, replace(asked, about=plan))
        said = "" if CHOSEN in explanation.answer else denied or "it did not: "
        return replace(explanation, answer=f"{said}{explanation.answer}")
    known = deeds.described(past, sentence.words, (Deed("world", each, 0.0) for each in FIELDS))
    if sentence.first not in _WHETHER | _WHEN or not known or sentence.is_only(deeds.MOVING):
        return None
    answer = f"{denied}`{known[-1].text}` was not recorded until {seconds(past.end)}"
    return Explanation(asked.written, answer)


_ANSWERS: Mapping[str, Answer] = {
    "event": explain_event,
    "plan": explain_plan,
    "belief": explain_belief,
    "command": explain_command,
    "sentence": explain_sentence,
}


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
        elif event in ("deliberation", "belief", "goal"):
            record = decoded(event, data)
            for asked, pattern in self._wanted.items():
                if pattern.fits(_trigger_of(record)):
                    self._explain(Question(asked, about=asked, agent=data["agent"]), record)

    def _explain(self, asked: Question, record: Any) -> None:
        past = Past.of(self._so_far())
        if isinstance(record, records.BeliefRecord) and _has_plan(past, record):
            return  # the event is explained when it is handled
        self._unmet.pop(asked.about, None)
        explained = explain_failure if isinstance(record, records.GoalRecord) else explain_event
        self._tell(explained(past, asked).text())


def _trigger_of(record: Any) -> str:
    """Return the event of a record; empty if it is not of interest."""
    match record:
        case records.DeliberationRecord():
            return record.trigger
        case records.BeliefRecord():
            return f"{record.op}{record.belief}"
    return record.goal if record.state == "failed" else ""


def _has_plan(past: Past, change: records.BeliefRecord) -> bool:
    """Return whether a plan may handle a belief change."""
    name, plans = name_of(change.belief), past.plans(change.agent)
    return any(
        each.trigger.startswith(change.op) and name_of(each.trigger) in (name, "") for _, each in plans
    )
