"""Words of questions and of recorded names, compared by their stems."""

import re
from collections.abc import Iterable

_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")
_IRREGULAR = {
    **dict.fromkeys(("went", "gone", "goes", "going"), "go"),
    **dict.fromkeys(("drove", "driven"), "drive"),
    **dict.fromkeys(("took", "taken"), "take"),
    **dict.fromkeys(("fell", "fallen"), "fall"),
    "stood": "stand",
    "came": "come",
    "brought": "bring",
}
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
    return frozenset(map(stem, text.split()))


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
EXACT, OF_PLACE, SIMILAR = 3, 2, 1
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
            total += EXACT
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


def name_verb(words: Iterable[str], name: Iterable[str]) -> bool:
    """Return whether stems name the verb of a thing: the first word of its name, such as ``find`` of ``find_dock``."""
    verb = next((word for word in name if word not in _SMALL), "")
    return any(closeness([word], [verb], (), ())[0] for word in words)
