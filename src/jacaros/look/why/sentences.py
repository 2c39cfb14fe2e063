"""Questions in sentences: ``why``, ``when``, ``how often``, ``did`` or ``is``, and words for what happened."""

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import NamedTuple

from jacaros.look.why.about_deeds import explain_failure, explain_outcome, explain_when, explain_why
from jacaros.look.why.about_events import CHOSEN, explain_belief, explain_event, explain_plan, plan_about
from jacaros.look.why.about_motion import explain_drive, explain_stop, explain_turn
from jacaros.look.why.about_now import explain_now
from jacaros.look.why.chains import with_values
from jacaros.look.why.deeds import beliefs, deeds_asked_for, described
from jacaros.look.why.explanation import Explanation, seconds
from jacaros.look.why.past import Deed, Past
from jacaros.look.why.patterns import Question, QuestionPattern, literal_at, name_of
from jacaros.look.why.words import (
    ARRIVING,
    ENDING,
    FAILING,
    MOVING,
    RESTING,
    STOPPING,
    TURNING,
    name_verb,
    stems,
    words_of,
)
from jacaros.robots.world.data.ground_truth import FIELDS

Answer = Callable[[Past, Question], Explanation]

LITERAL = re.compile(r"~?[a-z]\w*(?=\()|(?:(?<=^belief\s)|(?<=changed\s))~?[a-z]\w*")
_WORD = re.compile(r"[A-Za-z]+'[a-z]+|\w+")
NOW = words_of("is are am")
WHETHER = NOW | words_of("did does do has have had was were can could will would")
WHEN = words_of("when where how")
SUBJECT_FOLLOWS = WHETHER | {"", "agent", "robot", "for"}
"""Words before the subject, such as `did`; at the beginning, an empty one."""
_NEGATIONS = words_of("not never no")
_FILLERS = WHETHER.union(
    WHEN,
    _NEGATIONS,
    words_of(
        "what which who why a an the this that there then here now it its i me my you we us they their robot"
    ),
    words_of("agent run to into in on of off from for at by with about around up and so because"),
    words_of(
        "get got something anything someone everything need needed want wanted try tried last first again often time"
    ),
    words_of("times all happen happens happened led make made caused changed robots agents"),
)
"""Words that say nothing about what happened."""
_SUBJECTS: Sequence[tuple[frozenset[str], Answer]] = (
    (STOPPING, explain_stop),
    (RESTING, explain_now),
    (FAILING, explain_failure),
    (ENDING, explain_now),
)
"""Verbs that need no object, and what answers them."""
_MOTIONS: Sequence[tuple[frozenset[str], Answer]] = ((TURNING, explain_turn), (MOVING, explain_drive))
"""Verbs that the commands to the wheels explain if the program has no name for them."""
_OUTCOMES = ENDING | FAILING | STOPPING | RESTING | words_of("goal event plan")
"""Words about what else the question names."""


class _Sentence(NamedTuple):
    """The parts of a question: its words, the first of them, the stems of those that say what happened, and a negation."""

    said: list[str]
    first: str
    words: list[str]
    is_negated: bool

    @classmethod
    def of(cls, text: str, subjects: Iterable[str]) -> "_Sentence":
        said = [word.lower() for word in _WORD.findall(text)]
        negative = [word for word in said if word in _NEGATIONS or word.endswith("n't")]
        names = {name.lower() for name in subjects}
        before = (
            "",
            *said,
        )  # a name is the subject after a verb such as `did`; elsewhere, it may be that of a goal
        meant = [
            word
            for last, word in zip(before, said, strict=False)
            if not (word in names and last in SUBJECT_FOLLOWS)
        ]
        words = [part for word in meant if word not in _FILLERS and "'" not in word for part in stems(word)]
        return cls(said, said[0] if said else "", words, bool(negative))

    def is_only(self, verbs: frozenset[str]) -> bool:
        return bool(self.words) and verbs.issuperset(self.words)

    def words_missing_in(self, text: str) -> list[str]:
        return [word for word in self.words if word not in stems(text)]


def explain_sentence(past: Past, asked: Question) -> Explanation | None:
    """Explain what the words of a question describe; None if nothing of this run fits them."""
    sentence = _Sentence.of(asked.about, (*past.agents, *past.robots))
    if len(sentence.said) == 1 and any(name_of(data.belief) == asked.about for _, data in past.beliefs):
        return explain_belief(past, asked)
    for verbs, answer in _SUBJECTS:
        if not verbs.isdisjoint(sentence.words) and sentence.is_only(verbs | MOVING):
            return answer(past, asked)
    return (
        (_of_beliefs(past, asked, sentence) if sentence.first in NOW else None)
        or _of_deeds(past, asked, sentence)
        or next(
            (answer(past, asked) for verbs, answer in _MOTIONS if sentence.is_only(verbs - ARRIVING)), None
        )
        or _of_beliefs(past, asked, sentence)
        or _of_nothing(past, asked, sentence)
    )


def _of_deeds(past: Past, asked: Question, sentence: _Sentence) -> Explanation | None:
    """Explain the deeds that a sentence describes, or how they ended; None if there are none."""
    literal, deeds = LITERAL.search(asked.about), deeds_asked_for(past, asked)
    objects = [word for word in sentence.words if word not in _OUTCOMES]
    ends = False
    if literal is not None:
        pattern = QuestionPattern(literal_at(asked.about, literal.start()))
        found = [each for each in deeds if pattern.fits_literal(each.text)]
    else:
        found = described(past, sentence.words, deeds)
        if not found and objects:
            found, ends = described(past, objects, deeds), True
        if ARRIVING.issuperset(objects):  # without a destination, no drive is meant
            found = [each for each in found if not sentence.words_missing_in(each.text)]
    if not found:
        return None
    if sentence.first in WHEN:
        return explain_when(past, asked, found)
    if sentence.first in WHETHER or ends or sentence.is_negated:
        # Whether it did `dock` is not answered by yes or no if all that is known is the end of `find_dock`.
        is_named = literal is not None or name_verb(sentence.words, stems(name_of(found[-1].text)))
        why = "why not" if sentence.is_negated else "why"
        return explain_outcome(
            past, asked, found, sentence.first if sentence.first in WHETHER and is_named else why
        )
    if found[-1].kind == "event":
        return explain_event(past, replace(asked, about=found[-1].text))
    return explain_why(past, asked, found)


def _of_beliefs(past: Past, asked: Question, sentence: _Sentence) -> Explanation | None:
    """Explain the beliefs that a sentence describes, or those from which a rule concludes it; None if there are none."""
    found = described(past, sentence.words, beliefs(past, asked.agent))
    if found and sentence.first not in WHEN and MOVING.isdisjoint(sentence.words):
        return (explain_outcome if sentence.first in WHETHER else explain_why)(past, asked, found)
    for agent, rules in past.rules.items() if sentence.first in NOW else ():
        heads = (rule.partition(":-")[0].strip() for rule in rules)
        name = next((each for each in heads if sentence.words and {*stems(each)} >= {*sentence.words}), None)
        if name is not None and asked.agent in ("", agent):
            answer = f"a rule of {agent} decides {with_values(past, agent, name, past.end)}"
            return Explanation(asked.written, answer, past.end)
    return None


def _of_nothing(past: Past, asked: Question, sentence: _Sentence) -> Explanation | None:
    """Explain what did not happen: a plan, or an event of the world."""
    plan = (
        plan_about(past, sentence.words, asked.agent)
        if sentence.words and sentence.first not in NOW
        else None
    )
    if plan is not None:
        explanation = explain_plan(past, replace(asked, about=plan))
        denied = "no: " if sentence.first in WHETHER else "it did not: "
        done = CHOSEN in explanation.answer
        return explanation if done else replace(explanation, answer=f"{denied}{explanation.answer}")
    known = described(past, sentence.words, (Deed("world", each, 0.0) for each in FIELDS))
    if sentence.first not in WHETHER or not known or sentence.is_only(MOVING):
        return None
    return Explanation(asked.written, f"no: `{known[-1].text}` was not recorded until {seconds(past.end)}")
