"""What happened in a run, found by the words of a question: operations, goals, events, beliefs and changes of the world."""

import re
from collections.abc import Iterable, Iterator, Mapping

from jacaros.look.why.chains import shown
from jacaros.look.why.past import Deed, Past, of_agent
from jacaros.look.why.patterns import Question, name_of
from jacaros.look.why.words import closeness, stems

_POSITION = re.compile(r"[(,]\s*(-?\d+(?:\.\d+)?),\s*(-?\d+(?:\.\d+)?)(?=[,)])")
_NAMED = re.compile(r"[(,]\s*[a-z\"]")
_ORDER = ("world", "belief", "event", "goal", "operation")
"""Kinds of deeds; of those that fit equally well, a later kind is preferred, because it is what the robot itself did."""


def deeds_asked_for(past: Past, asked: Question) -> list[Deed]:
    """Return everything that happened, but for beliefs, of the agent and to the robot asked about."""

    def is_meant(deed: Deed) -> bool:
        whose = asked.robot if deed.kind == "world" else asked.agent
        return "" in (whose, deed.agent) or deed.agent == whose

    return [*filter(is_meant, _deeds(past))]


def _deeds(past: Past) -> Iterator[Deed]:
    yield from past.operations.values()
    yield from _goals(past)
    for t, event in past.deliberations:
        if not {"!", "?"} & set(event.trigger[:2]):
            yield Deed("event", event.trigger, t, event.agent, link=event.id)
    for t, what, robot in past.world:
        yield Deed("world", what, t, robot)


def _goals(past: Past) -> Iterable[Deed]:
    links = {(data.agent, data.trigger, t): data.id for t, data in past.deliberations}
    found: dict[object, Deed] = {}
    for t, data in past.goals:
        key = data.agent, data.goal, data.id
        known = found.get(key)
        if known is None or (data.state == "pursued" and data.id is None):
            if known is not None:
                found[(*key, t)] = known
            link = links.get((data.agent, f"+{data.goal}", t))
            known = Deed("goal", data.goal, t, data.agent, link=link)
        if data.state in ("pursued", "resumed", "suspended"):
            state = "suspended" if data.state == "suspended" else "pursued"
            found[key] = known._replace(state=state, ended=None)
        else:
            found[key] = known._replace(state=data.state, ended=t, why=data.why or known.why)
    return found.values()


def beliefs(past: Past, agent: str) -> Iterable[Deed]:
    """Return the beliefs of an agent, or of all (``""``), each with its last change."""
    found: dict[object, Deed] = {}
    for t, data in of_agent(past.beliefs, agent):
        key = data.agent, data.belief
        deed = Deed("belief", data.belief, t, data.agent, "holds", None, "", data.cause)
        if data.op != "+":
            deed = found.get(key, deed)._replace(state="over", ended=t)
        found[key] = deed
    return found.values()


def described(past: Past, words: list[str], deeds: Iterable[Deed]) -> list[Deed]:
    """Return the deeds that words describe best, of the same name, the oldest first; empty if there are none."""
    places, known = places_of(past), dict[str, tuple[int, int]]()

    def fit(deed: Deed) -> tuple[int, bool, int, int]:
        if deed.text not in known:
            known[deed.text] = _closeness(words, deed.text, places)
        score, others = known[deed.text]
        return score, deed.kind != "world", others, _ORDER.index(deed.kind)

    fits = [(fit(each), each) for each in deeds]
    best = max((each for each, _ in fits), default=(0, False, 0, 0))
    found = sorted((deed for each, deed in fits if each == best and best[0]), key=lambda deed: deed.began)
    return [each for each in found if name_of(each.text) == name_of(found[-1].text)]


def _closeness(words: list[str], text: str, places: Mapping[tuple[str, str], str]) -> tuple[int, int]:
    plain = shown(text).partition("[source(")[0]
    name = name_of(plain) or plain
    return closeness(words, stems(name), stems(plain), stems(place_of_deed(plain, places)))


def place_of_deed(text: str, places: Mapping[tuple[str, str], str]) -> str:
    """Return the belief about the place that a deed is about; empty if it is not about one."""
    position = _POSITION.search(text)
    return places.get((position[1], position[2]), "") if position else ""


def places_of(past: Past) -> dict[tuple[str, str], str]:
    """Return the agents' own beliefs that name a position, such as ``place(dock,1,1,0)`` or ``dock(1,1)``, by x and y."""
    found: dict[tuple[str, str], str] = {}
    for _, data in past.beliefs:
        belief, _, annotations = data.belief.partition("[")
        position = _POSITION.search(belief) if "source(self)" in annotations else None
        if position and (_NAMED.search(belief) or belief.count(",") == 1):
            found.setdefault((position[1], position[2]), belief)
    return found
