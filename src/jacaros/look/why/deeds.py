"""What happened in a run, found by the words of a question: operations, goals, events, beliefs and changes of the world.

Words of questions and of recorded names are compared by their stems.
"""

import re
from collections.abc import Iterable, Mapping
from functools import cache, partial

from jacaros.look.why.chains import shown
from jacaros.look.why.past import Deed, Past, of_agent
from jacaros.look.why.patterns import Question, name_of

_POSITION = re.compile(r"[(,]\s*(-?\d+(?:\.\d+)?),\s*(-?\d+(?:\.\d+)?)(?=[,)])")
_NAMED = re.compile(r"[(,]\s*[a-z\"]")
_ORDER = ("world", "belief", "event", "goal", "operation")
"""Kinds of deeds; of those that fit equally well, a later kind is preferred, because it is what the robot itself did."""


def deeds_asked_for(past: Past, asked: Question) -> list[Deed]:
    """Return everything that happened, but for beliefs, of the agent and to the robot asked about."""
    events = (
        Deed("event", event.trigger, t, event.agent, link=event.id)
        for t, event in past.deliberations
        if not {"!", "?"} & set(event.trigger[:2])
    )
    world = (Deed("world", what, t, robot) for t, what, robot in past.world)
    own = (*past.operations.values(), *_goals(past), *events)
    found = [each for each in own if "" in (asked.agent, each.agent) or each.agent == asked.agent]
    return found + [each for each in world if asked.robot in ("", each.agent)]


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
    """Return the deeds that words describe best, of the same name, the oldest first; empty if nothing fits."""
    closeness_of = cache(partial(_closeness, words, places_of(past)))

    def fit(deed: Deed) -> tuple[int, bool, int, int]:
        score, others = closeness_of(deed.text)
        return score, deed.kind != "world", others, _ORDER.index(deed.kind)

    fits = [(fit(each), each) for each in deeds]
    best = max((each for each, _ in fits), default=(0, False, 0, 0))
    found = sorted((deed for each, deed in fits if each == best and best[0]), key=lambda deed: deed.began)
    return [each for each in found if name_of(each.text) == name_of(found[-1].text)]


def _closeness(words: list[str], places: Mapping[tuple[str, str], str], text: str) -> tuple[int, int]:
    plain = shown(text).partition("[source(")[0]
    return closeness(words, stems(name_of(plain) or plain), stems(plain), stems(place_of_deed(plain, places)))


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


# ---- words

_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")
_FORMS = "go went gone goes going,drive drove driven,take took taken,fall fell fallen,stand stood,come came,bring brought"
_IRREGULAR = {form: forms.split()[0] for forms in _FORMS.split(",") for form in forms.split()}
_SUFFIXES = ("ing", "ed", "es", "s", "e")
_SHORTEST = 3
"""Minimum number of letters of a stem that a suffix is cut from."""


def stem(word: str) -> str:
    """Return the stem of a word, the same for ``recharge``, ``recharged`` and ``recharging``."""
    word = _IRREGULAR.get(word.lower(), word.lower())
    for suffix in _SUFFIXES:
        if word.endswith(suffix) and len(word) - len(suffix) >= _SHORTEST:
            word = word.removesuffix(suffix)
            break
    if len(word) > _SHORTEST and word[-1] in ("i", word[-2]):
        word = f"{word[:-1]}{'y' if word[-1] == 'i' else ''}"
    return word.removesuffix("y") if word.endswith("ery") else word


def stems(text: str) -> list[str]:
    """Return the stems of the words of a text; those of ``dockAndCharge`` and ``dock_and_charge`` are the same."""
    return [stem(word) for word in _WORD.findall(text)]


def words_of(text: str) -> frozenset[str]:
    """Return the words of a text."""
    return frozenset(text.split())


def stems_of(text: str) -> frozenset[str]:
    """Return the stems of the words of a text."""
    return frozenset(stems(text))


MOVING = stems_of("go drive move navigate travel reach arrive come return visit")
ARRIVING = stems_of("reach arrive come return visit")
TURNING = stems_of("turn rotate spin")
STOPPING = stems_of("stop halt")
RESTING = stems_of("stand still stay idle wait stuck hang nothing silent doing blocked")
FAILING = stems_of("fail failure wrong error problem")
ENDING = stems_of(
    "end finish complete over exit achieve succeed success drop abandon cancel interrupt suspend pause"
)
_SYNONYMS = (
    MOVING,
    TURNING,
    stems_of("charge recharge"),
    stems_of("bump collide collision hit"),
    stems_of("pick grasp grab take"),
)
"""Words of people for names of programs. Everything else must be named as the program does."""
IN_NAME, IN_ARGUMENTS, OF_PLACE, SIMILAR = 4, 3, 2, 1
_SMALL = frozenset(("to", "into", "in", "at", "of", "the", "and", "operation"))


def closeness(
    words: Iterable[str], name: Iterable[str], arguments: Iterable[str], place: Iterable[str]
) -> tuple[int, int]:
    """Return how closely words describe a thing: the greater, the closer; (0, 0) if they do not.

    The second number is minus the number of other words in the name. Without those, a verb of motion may be missing: a
    robot *goes* to the dock by ``dock_at("dock_1")``.

    Args:
        words: stems of the question.
        name, arguments: stems of the thing.
        place: stems of the name of the place that its arguments are the position of.
    """
    own, covered, missing, total = {*name}, set[str](), False, 0
    known = own.union(arguments)
    for word in words:
        similar = next((group & own for group in _SYNONYMS if word in group), set[str]())
        if word in known:
            covered.add(word)
            total += IN_NAME if word in own else IN_ARGUMENTS
        elif word in place:
            total += OF_PLACE
        elif similar:
            covered |= similar
            total += SIMILAR
        elif word in MOVING:
            missing = True
        else:
            return 0, 0
    others = len(own - covered - _SMALL)
    return (total, -others) if total and not (missing and others) else (0, 0)


def is_named(deed: Deed, words: Iterable[str]) -> bool:
    """Return whether stems name what a deed does, by the first word of its name, such as ``find`` of ``find_dock``; or a
    belief, by any word of its name.
    """
    name = [word for word in stems(name_of(deed.text)) if word not in _SMALL]
    if deed.kind == "belief":
        return not {*words}.isdisjoint(name)
    return any(closeness([word], name[:1], (), ())[0] for word in words)
