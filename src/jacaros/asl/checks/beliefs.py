"""What a program asks about beliefs, and what it says that could make them."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Final

from jacaros.asl import nodes
from jacaros.asl.checks.formulas import clauses, in_order, parts_of
from jacaros.asl.spelling import is_slip_of
from jacaros.asl.walk import walk

_SENDS: Final = frozenset({".send", ".broadcast"})
_ADDING: Final = frozenset({".include", ".add_plan", ".create_agent", ".clone", ".load_agent"})
"""Internal actions that bring in plans or agents which do not stand in the program."""
_QUERIES: Final = {".count": 0, ".findall": 1, ".setof": 1}
"""Internal actions with a condition among their arguments."""
_WORD: Final = re.compile(r"\w+")
_SHORTEST: Final = 5
"""Shorter names are too easily like each other."""
_SHORTEST_PART: Final = 3
"""So are shorter parts of names with underscores."""
_ENDINGS: Final = "sdr"
"""Letters that make another form of a word."""


@dataclass
class Beliefs:
    """The names of beliefs in a program.

    Attributes:
        asked: what plans react to and conditions ask for, by name.
        made: names that the program gives to beliefs of its own and of others.
        mentioned: all other names in it, and words of strings: they may become beliefs by ways that are not seen.
        is_open: beliefs, plans or agents come from elsewhere at run time.
    """

    asked: dict[str, list[nodes.Literal]] = field(default_factory=dict)
    made: set[str] = field(default_factory=set)
    mentioned: set[str] = field(default_factory=set)
    is_open: bool = False


def beliefs_of(program: nodes.Program) -> Beliefs:
    """Look through a program, with all that it includes."""
    found = Beliefs()
    for belief in program.beliefs:
        head = belief.head if isinstance(belief, nodes.Rule) else belief
        found.made.update(_names(head))
    asked: set[int] = set()
    for clause in clauses(program):
        for node, is_asked in in_order(clause):
            _look_at(node, is_asked, asked, found)
    for node in walk(program.beliefs, program.goals, program.plans):
        if isinstance(node, nodes.Literal) and id(node) not in asked:
            found.mentioned.add(_name(node))
        elif isinstance(node, nodes.String):
            found.mentioned.update(_WORD.findall(node.value))
    return found


def _look_at(node: nodes.Node, is_asked: bool, asked: set[int], found: Beliefs) -> None:
    if isinstance(node, nodes.Trigger):
        if node.kind == "" and node.operator in "+-":
            _ask(node.literal, asked, found)
        elif node.kind == "?":
            found.made.update(_names(node.literal))
    elif isinstance(node, nodes.BeliefChange):
        found.is_open = found.is_open or isinstance(node.operand, nodes.Variable)
        if isinstance(node.operand, nodes.Literal) and "+" in node.operator:
            found.made.add(_name(node.operand))
    elif isinstance(node, nodes.InternalAction):
        found.is_open = found.is_open or node.name in _ADDING
        if node.name in _SENDS and node.arguments:
            found.made.update(_names(node.arguments[-1]))
        for condition in node.arguments[_QUERIES.get(node.name, len(node.arguments)) :][:1]:
            for part in parts_of(condition):
                _ask(part, asked, found)
    elif is_asked:
        _ask(node, asked, found)


def _ask(node: nodes.Node, asked: set[int], found: Beliefs) -> None:
    """Note a literal that is asked for; those of other namespaces may be anybody's."""
    if isinstance(node, nodes.Literal) and node.namespace is None:
        asked.add(id(node))
        found.asked.setdefault(_name(node), []).append(node)


def _names(term: nodes.Node) -> Iterator[str]:
    """The name of a belief, or of each in a list of them."""
    for node in term.items if isinstance(term, nodes.ListTerm) else (term,):
        if isinstance(node, nodes.Literal):
            yield _name(node)


def _name(literal: nodes.Literal) -> str:
    return literal.functor.strip("'")


def is_misspelt(written: str, meant: str) -> bool:
    """Whether *written* is surely meant to be *meant*.

    Names with numbers (``room1``, ``room2``), plurals and other forms of a word (``close``, ``closed``), short names, names
    that begin otherwise, and those that differ in a short part (``pos_x``, ``pos_y``) are names of their own.
    """
    if len(meant) < _SHORTEST or written[0] != meant[0] or not is_slip_of(written, meant):
        return False
    if any(character.isdigit() for character in written + meant):
        return False
    if any(f"{written}{ending}" == meant or f"{meant}{ending}" == written for ending in _ENDINGS):
        return False
    parts, wanted = written.split("_"), meant.split("_")
    return len(parts) != len(wanted) or all(
        min(len(one), len(two)) >= _SHORTEST_PART
        for one, two in zip(parts, wanted, strict=True)
        if one != two
    )
