"""What happened in a run, folded into tales: events of one kind are one tale with their number.

So twelve hours of patrol and one failure are two tales. `Rank` orders them by what matters first.
"""

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any, Literal, NamedTuple

from jacaros.look.records.records import Data, is_well_formed
from jacaros.look.records.words import cut
from jacaros.look.why.about_now import ending_step
from jacaros.look.why.chains import shown
from jacaros.look.why.past import AT_ONCE, Past
from jacaros.look.why.patterns import name_of

MOST_NAMES = 3
"""Maximum number of agents, robots or goals that a line names."""
MOST_PURSUITS = 3
"""Number of goals, those that were pursued longest, that come before faults and failures that a plan handled."""
LASTING = 1.0
"""Seconds from which on a goal is more than setup."""
LONG = 5.0
"""Seconds from which on a robot that is wrong about its pose, or an agent without a goal, is worth a line."""
LONGEST = 160
"""Maximum number of characters of a reason."""

_SIGNALS = 128
"""Exit codes from here on mean that a signal ended the run, such as that of Ctrl+C (130)."""

Level = Literal["error", "warning", "note"]
Key = tuple[str, Any]
"""An agent and its intention."""


class Rank(IntEnum):
    """What matters first: tales of a lower rank stay when there are too many."""

    END = 0
    LOSS = 1
    PURSUIT = 2
    FAULT = 3
    TROUBLE = 4
    HANDLED = 5
    ROUTINE = 6


@dataclass(frozen=True, slots=True)
class StoryLine:
    """A line of a story.

    Attributes:
        t: seconds since the run began; of several events, of the first one.
        text: what happened, and to whom.
        level: ``error``, ``warning`` or ``note``.
        count, until: number of the events that are folded into this line, and the time of the last one.
        agent, robot: what it concerns, if that is one.
    """

    t: float
    text: str
    level: Level
    count: int = 1
    until: float | None = None
    agent: str = ""
    robot: str = ""


@dataclass
class Tale:
    """Events of one kind.

    Attributes:
        goals, states: of a pursuit, its goals, and how they ended.
        lasts: whether it lasts from the first event to the last one.
    """

    rank: Rank
    t: float
    text: str
    level: Level = "note"
    robot: str = ""
    lasts: bool = False
    count: int = 1
    last: float = 0.0
    who: dict[str, None] = field(default_factory=dict)
    goals: dict[str, None] = field(default_factory=dict)
    states: set[str] = field(default_factory=set)

    @property
    def weight(self) -> tuple[Rank, float]:
        """What matters first has the least: of failures the first one, otherwise what lasted longest."""
        return self.rank, self.t if self.level != "note" else self.t - self.last

    def line(self) -> StoryLine:
        """Return it as a line of the story."""
        text = self._pursuit() if self.goals else self.text
        text = f"{_names([*self.who])}: {text}" if self.who else text
        has_end = (self.count > 1 or self.lasts) and self.last > self.t
        until = round(self.last, 3) if has_end else None
        count = self.count if self.count > len(self.who) and not self.goals else 1
        single = next(iter(self.who)) if len(self.who) == 1 else ""
        agent, robot = ("", single) if self.robot else (single, "")
        return StoryLine(round(self.t, 3), text, self.level, count, until, agent, robot)

    def _pursuit(self) -> str:
        """Return what was pursued in words; rounds of a loop by their name, because they differ in their arguments."""
        verb = "achieved" if self.states == {"achieved"} else "pursued"
        goal = shown(next(iter(self.goals)))
        if len(self.goals) > 1:
            goal = f"!{name_of(goal)}"
        rounds = f", {self.count} rounds" if self.count > len(self.who) else ""
        return f"{verb} `{goal}`{rounds}"


@dataclass
class _Pursuit:
    """An open root goal of an intention: its goals by number, and its tale."""

    stack: dict[Any, str]
    tale: Tale


@dataclass
class _Failure:
    """The goals of an intention that failed together by number, the inner ones first."""

    t: float
    why: str
    goals: dict[Any, str] = field(default_factory=dict)


class Teller:
    """Takes the records of a run and folds them into tales."""

    def __init__(self) -> None:
        self._tales: dict[tuple[str, str], Tale] = {}
        self._pursuits: dict[Key, _Pursuit] = {}
        self._failures: dict[Key, _Failure] = {}
        self._suspended: dict[Key, Tale] = {}
        self._over: dict[Key, float] = {}
        """When suspended intentions ended."""
        self._open: dict[str, set[Any]] = {}
        self._idle: dict[str, float] = {}
        """Since when agents have no intention; those that have one are in *_open*."""
        self._dropped: list[tuple[float, str, str]] = []
        self._warnings: list[tuple[float, Data]] = []
        self._take: Mapping[str, Callable[[float, Data], None]] = {
            "goal": self._goal,
            "intention": self._intention,
            "log": self._log,
            "agent": self._agent,
            "member": self._member,
            "believed": self._believed,
            "fault": self._fault,
            "property": self._property,
        }

    def take(self, t: float, event: str, data: Data) -> None:
        """Take the next record."""
        is_other = event == "property" and data.get("name") != "question"
        kind = _KINDS.get(event)
        if is_other or not (event in self._take or (kind and kind.text)) or not is_well_formed(event, data):
            return
        if event in self._take:
            self._take[event](t, data)
        elif kind is not None:
            self._tell(event, t, kind.text.format_map(data), robot=str(data.get("robot") or ""))

    def tales(self, past: Past, is_over: bool = True) -> list[Tale]:
        """Return all tales; *past* has the programs, and how the run ended."""
        for key, failure in self._failures.items():
            self._fail(key, failure)
        self._tell_warnings()
        for pursuit in self._pursuits.values():
            pursuit.tale.last = past.end
            pursuit.tale.states.add("open")
        self._tell_suspended(past)
        pursuits = [each for each in self._tales.values() if each.goals]
        pursuits.sort(key=lambda each: each.weight)
        for each in pursuits[:MOST_PURSUITS]:
            each.rank = Rank.PURSUIT
        setup = [each for each in pursuits[1:] if each.last - each.t < LASTING]
        return [*(each for each in self._tales.values() if each not in setup), self._end(past, is_over)]

    def _tell(self, kind: str, t: float, text: str, who: str = "", robot: str = "", about: str = "") -> Tale:
        """Add to the tale of a kind and a text, or *about* in its place."""
        rank, level, _, lasts = _KINDS[kind]
        known = self._tales.get((kind, about or text))
        if known is None:
            known = Tale(rank, t, text, level, robot, lasts, count=0)
            self._tales[kind, about or text] = known
        known.count += 1
        known.last = t
        if who or robot:
            known.who[who or robot] = None
        return known

    # ---- goals

    def _goal(self, t: float, data: Data) -> None:
        state, goal, number = data["state"], data["goal"], data.get("id")
        key: Key = data["agent"], data.get("intention") or f"goal {number}"
        failure = self._failures.get(key)
        if failure is not None and (state != "failed" or t > failure.t):
            del self._failures[key]
            # A goal with a plan for its failure is pursued again.
            is_handled = number in failure.goals and state in ("pursued", "recovered")
            self._fail(key, failure, is_handled)
        if state == "pursued":
            self._begin(t, key, number, goal)
        elif state == "failed":
            self._failures.setdefault(key, _Failure(t, data.get("why") or "")).goals[number] = goal
        elif state == "suspended":
            self._suspend(t, key, number)
        elif state == "resumed":
            if key in self._suspended:
                self._suspended.pop(key).last = t
        else:
            self._close(t, key, number, state)

    def _begin(self, t: float, key: Key, number: Any, goal: str) -> None:
        self._open.setdefault(key[0], set()).add(key[1])
        if key not in self._pursuits:
            tale = self._tell("goal", t, "", key[0], about=name_of(goal))
            tale.goals[goal] = None
            self._pursuits[key] = _Pursuit({}, tale)
        self._pursuits[key].stack[number] = goal

    def _close(self, t: float, key: Key, number: Any, state: str) -> None:
        pursuit = self._pursuits.get(key)
        if pursuit is None or number not in pursuit.stack:
            return
        if number == next(iter(pursuit.stack)):
            if state == "dropped":
                self._dropped.append((t, key[0], pursuit.stack[number]))
            self._end_intention(t, key, state)
        else:
            del pursuit.stack[number]

    def _suspend(self, t: float, key: Key, number: Any) -> None:
        pursuit = self._pursuits.get(key)
        if pursuit is not None and number == next(iter(pursuit.stack)):
            told = f"`!{name_of(pursuit.stack[number])}` was suspended"
            self._suspended[key] = self._tell("suspended", t, told, key[0])

    def _tell_suspended(self, past: Past) -> None:
        """Warn of agents all of whose goals were suspended at the end: nothing was left to resume them."""
        left = [key for key in self._suspended if past.end - self._over.get(key, past.end) <= AT_ONCE]
        suspended, wanted = [agent for agent, _ in left], [agent for agent, _ in self._wanted(past)]
        for key in left:
            if suspended.count(key[0]) == wanted.count(key[0]):
                tale = self._suspended[key]
                tale.rank, tale.level, tale.last = Rank.TROUBLE, "warning", past.end

    def _end_intention(self, t: float, key: Key, state: str = "") -> None:
        pursuit = self._pursuits.pop(key, None)
        if pursuit is not None:
            pursuit.tale.last = t
            pursuit.tale.states.update({state} - {"replaced"})
        if key in self._suspended:
            self._over[key] = self._suspended[key].last = t
        intentions = self._open.get(key[0], set())
        intentions.discard(key[1])
        if not intentions:
            self._idle[key[0]] = t

    def _fail(self, key: Key, failure: _Failure, is_handled: bool = False) -> None:
        because, goal = reason(failure.why), [*failure.goals.values()][-1]
        told = f"`{cut(shown(goal), LONGEST)}` failed{f': {because}' if because else ''}"
        if is_handled:
            # Consecutive goals that fail for one reason are one tale.
            self._tell("handled", failure.t, f"{told}; a plan handled it", key[0], about=_pattern(because))
        else:
            self._tell("lost", failure.t, told, key[0], about=f"{name_of(goal)} {_pattern(because)}")
            self._end_intention(failure.t, key)

    def _intention(self, t: float, data: Data) -> None:
        if data["state"] == "over":
            self._end_intention(t, (data["agent"], data["id"]))
        else:
            self._open.setdefault(data["agent"], set()).add(data["id"])

    # ---- the rest of the run

    def _tell_warnings(self) -> None:
        """Tell the warnings that no failed goal has told."""
        lost = [tale for key, tale in self._tales.items() if key[0] == "lost"]
        for t, data in self._warnings:
            found = _WARNING.match(data["text"])
            is_loss = found is not None and _LOST in data["text"]
            if is_loss and any(each.t - AT_ONCE <= t <= each.last + AT_ONCE for each in lost):
                continue
            who, text = (found[1], found[2]) if found is not None else ("", data["text"].partition("\n")[0])
            if is_loss:
                text = f"{text.partition(_LOST)[0]}: {reason(text)}"
            self._tell(
                "error" if is_loss else data["level"], t, cut(text, LONGEST), who, about=_pattern(text)
            )

    def _log(self, t: float, data: Data) -> None:
        if data["level"] in ("warning", "error"):
            self._warnings.append((t, data))

    def _agent(self, t: float, data: Data) -> None:
        if data["state"] == "ended":
            self._open.pop(data["agent"], None)
            self._idle.pop(data["agent"], None)
        else:
            self._idle.setdefault(data["agent"], t)

    def _member(self, t: float, data: Data) -> None:
        if data["state"] == "lost":
            self._tell("member", t, _KINDS["member"].text, data["member"], about=data["member"])

    def _fault(self, t: float, data: Data) -> None:
        text = f"fault `{data['fault']}` ({data['kind'].replace('_', ' ')})"
        if data["state"] != "ends":
            self._tell("fault", t, text, robot=str(data.get("robot") or ""))
        elif (begun := self._tales.get(("fault", text))) is not None:
            begun.last = t

    def _believed(self, t: float, data: Data) -> None:
        """Tell of a robot that is wrong about its pose. The record is repeated while it is, then once without a pose."""
        if data.get("x") is not None:
            tale = self._tell("believed", t, _KINDS["believed"].text, robot=data["robot"])
            tale.count = 1
            if tale.last - tale.t >= LONG:
                tale.rank, tale.level = Rank.TROUBLE, "warning"

    def _property(self, t: float, data: Data) -> None:
        """Tell of a question to a person: the values are its number, its text and the options."""
        if len(data["values"] or ()) > 1:
            self._tell("property", t, f"a person was asked: {cut(str(data['values'][1]), LONGEST)}")

    # ---- the end

    def _wanted(self, past: Past) -> list[tuple[str, str]]:
        """Return the goals that the end of the run took from agents, or that were open then."""
        dropped = [(agent, goal) for t, agent, goal in self._dropped if past.end - t <= AT_ONCE]
        return dropped + [(key[0], next(iter(each.stack.values()))) for key, each in self._pursuits.items()]

    def _end(self, past: Past, is_over: bool) -> Tale:
        code, step = past.exit_code, ending_step(past)
        because = f", because {step.agent} ran {step.text}" if step is not None else ""
        parts = [f"the run ended with exit code {code}{because}"]
        cut_off = code is None and is_over
        if code is None:
            parts = ["the recording stops before the end of the run" if is_over else "the run continues"]
        elif code >= _SIGNALS:
            parts = [f"the run was stopped by signal {code - _SIGNALS}"]
        lost = {name for key, tale in self._tales.items() if key[0] == "lost" for name in tale.who}
        silent = {each: past.end - t for each, t in self._idle.items() if not self._open.get(each)}
        quiet = [each for each, passed in silent.items() if passed >= (AT_ONCE if each in lost else LONG)]
        lost.intersection_update(quiet)
        ended = self._wanted(past)
        if idle := [each for each in quiet if each in lost] or (quiet if not ended else []):
            since = min(silent[each] for each in idle)
            parts.append(f"{_names(idle)} had no goal for the last {_duration(since)}")
        if ended:
            agents = len({agent for agent, _ in ended})
            by = f" by {agents} agents" if agents > 1 else ""
            what = "still wanted" if is_over else "pursued"
            parts.append(f"{what}{by}: {_names(sorted({f'`{shown(goal)}`' for _, goal in ended}))}")
        level: Level = "error" if lost or 0 < (code or 0) < _SIGNALS else "note"
        return Tale(Rank.END, past.end, "; ".join(parts), "warning" if cut_off else level)


class _Kind(NamedTuple):
    """A kind of tales; *text* is that of a record that needs nothing else.

    *lasts*: whether it lasts from the first event to the last one.
    """

    rank: Rank
    level: Level
    text: str = ""
    lasts: bool = False


_KINDS: Mapping[str, _Kind] = {
    "goal": _Kind(Rank.ROUTINE, "note", lasts=True),
    "suspended": _Kind(Rank.ROUTINE, "note", lasts=True),
    "handled": _Kind(Rank.HANDLED, "warning"),
    "lost": _Kind(Rank.LOSS, "error"),
    "warning": _Kind(Rank.TROUBLE, "warning"),
    "error": _Kind(Rank.LOSS, "error"),
    "member": _Kind(Rank.FAULT, "error", "did not answer; it is a system of the fleet"),
    "fault": _Kind(Rank.FAULT, "warning", lasts=True),
    "believed": _Kind(Rank.ROUTINE, "note", "was not where it believed to be", lasts=True),
    "property": _Kind(Rank.FAULT, "warning"),
    "intervention": _Kind(Rank.FAULT, "note", "you changed the run: {what}"),
    "battery_empty": _Kind(Rank.LOSS, "error", "the battery is empty"),
    "fell": _Kind(Rank.LOSS, "error", "fell down a cliff"),
    "bump": _Kind(Rank.TROUBLE, "warning", "bumped into a wall, {side}"),
    "collision": _Kind(Rank.TROUBLE, "warning", "collided with {with}, {side}"),
    "command_timeout": _Kind(Rank.TROUBLE, "warning", "stopped, because no commands arrived"),
    "charged": _Kind(Rank.ROUTINE, "note", "charged its battery"),
    "task": _Kind(Rank.ROUTINE, "note", "did {task}"),
}

_LOST = " failed and has no plan for its failure"
_WARNING = re.compile(r"\[([^\]]+)\] (?:warning: |error: )?(.*)")
_NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
_NOISE = re.compile(
    rf"^.*{_LOST}: |^\w+, (?=\S)|^(?:action|operation) \S+ .*?(?:was aborted|failed)(?: with code -?\d+)?: "
)
_PLACE = re.compile(r" \(\S+:\d+\)$")


def reason(why: str) -> str:
    """Return why a goal failed in its shortest words: without the name of the error, the action and the place."""
    words = _PLACE.sub("", why.partition("\n")[0])
    for _ in range(3):  # each may be behind another
        words = _NOISE.sub("", words)
    return cut(words, LONGEST)


def _pattern(text: str) -> str:
    return _NUMBER.sub("#", text)


def _names(names: Iterable[str]) -> str:
    first = [*names]
    more = f" and {len(first) - MOST_NAMES} more" if len(first) > MOST_NAMES else ""
    return ", ".join(first[:MOST_NAMES]) + more


def _duration(t: float) -> str:
    if t < 120:
        return f"{t:.0f} s"
    return f"{t / 60:.0f} min" if t < 7200 else f"{t / 3600:.1f} h"
