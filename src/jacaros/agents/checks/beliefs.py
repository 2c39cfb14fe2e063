"""Collect the beliefs that a program asks for, and the text in it that may add them.

>>> from jacaros.agents.language.loader import load_program
>>> found = beliefs_of(load_program("robot.asl", "at(home). +!go : near(X) <- +at(X).")[0], {})
>>> found.made, list(found.asked)
({'at'}, ['near'])
>>> is_misspelt("batery", "battery"), is_misspelt("room1", "room2")
(True, False)
"""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final

from jacaros.agents.checks.formulas import clauses, in_order
from jacaros.agents.language import nodes
from jacaros.agents.language.cursor import is_slip_of
from jacaros.agents.language.lowering import format_term
from jacaros.agents.language.nodes import UNDECLARED, Declaration, parts_of, walk

_WORD: Final = re.compile(r"\w+")
_SHORTEST: Final = 5
"""Names shorter than this are too easily similar."""
_SHORTEST_PART: Final = 3
"""Parts of names between underscores that are shorter than this are too easily similar."""
_ENDINGS: Final = "sdr"
"""Letters that make another form of a word."""


@dataclass
class Beliefs:
    """The names of beliefs in a program.

    Attributes:
        asked: beliefs that plans react to and conditions ask for, by name.
        made: names of beliefs that the program gives itself and others.
        mentioned: all other names in it, and words of strings: they may become beliefs in ways that are not visible.
        is_open: beliefs, plans or agents come from elsewhere at run time.
        facts: initial beliefs, by name.
    """

    asked: dict[str, list[nodes.Literal]] = field(default_factory=dict)
    made: set[str] = field(default_factory=set)
    mentioned: set[str] = field(default_factory=set)
    is_open: bool = False
    facts: dict[str, list[nodes.Literal]] = field(default_factory=dict)


def beliefs_of(program: nodes.Program, actions: Mapping[str, Declaration]) -> Beliefs:
    """Collect the beliefs of a program and its includes; *actions* are the internal actions by name."""
    found = Beliefs()
    for belief in program.beliefs:
        if isinstance(belief, nodes.Rule):
            found.made.add(_name(belief.head))
        else:
            found.made.add(_name(belief))
            found.facts.setdefault(_name(belief), []).append(belief)
    asked: set[int] = set()
    for clause in (*clauses(program), *program.goals):
        for node, is_asked in in_order(clause):
            if isinstance(node, nodes.InternalAction):
                _look_at_call(node, actions.get(node.name, UNDECLARED), asked, found)
            else:
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
            _make(node.literal, found)
    elif isinstance(node, nodes.BeliefChange):
        if id(node) in asked:
            return
        found.is_open = found.is_open or isinstance(node.operand, nodes.Variable)
        if "+" in node.operator:
            _make(node.operand, found)
    elif is_asked:
        _ask(node, asked, found)


def _look_at_call(node: nodes.InternalAction, action: Declaration, asked: set[int], found: Beliefs) -> None:
    for change in _awaited(node) if action.awaits else ():
        asked.add(id(change))
        _ask(change.operand, asked, found)
    found.is_open = found.is_open or action.brings_in
    if action.performative is not None and node.arguments:
        _make(node.arguments[-1], found)
    if action.condition is not None:
        for condition in node.arguments[action.condition :][:1]:
            for part in parts_of(condition):
                _ask(part, asked, found)


def _awaited(wait: nodes.InternalAction) -> Iterator[nodes.BeliefChange]:
    """Yield the event ``{+b}`` or ``{-b}`` that a ``.wait`` waits for: it parses as a belief change."""
    for argument in wait.arguments:
        if isinstance(argument, nodes.BodyTerm):
            yield from (step for step in argument.body.steps if isinstance(step, nodes.BeliefChange))


def _ask(node: nodes.Node, asked: set[int], found: Beliefs) -> None:
    """Note a literal that is asked for; beliefs of other namespaces may come from anywhere."""
    if isinstance(node, nodes.Literal) and node.namespace is None:
        asked.add(id(node))
        found.asked.setdefault(_name(node), []).append(node)


def _make(term: nodes.Node, found: Beliefs) -> None:
    """Note a belief that is added, or a list of them."""
    for node in term.items if isinstance(term, nodes.ListTerm) else (term,):
        if isinstance(node, nodes.Literal):
            found.made.add(_name(node))


def is_fact_of(asked: nodes.Literal, fact: nodes.Literal) -> bool:
    """Return whether a literal asks for values that a fact of another name has.

    It does if there are constant arguments, and the fact has the same constants in those places.
    """
    if len(asked.arguments) != len(fact.arguments):
        return False
    pairs = [
        (format_term(one), format_term(other))
        for one, other in zip(asked.arguments, fact.arguments, strict=True)
        if not isinstance(one, nodes.Variable)
    ]
    return bool(pairs) and all(one == other for one, other in pairs)


def _name(literal: nodes.Literal) -> str:
    return literal.functor.strip("'")


def is_misspelt(written: str, meant: str) -> bool:
    """Return whether *written* is clearly a misspelling of *meant*.

    Names with digits (``room1``, ``room2``), plurals and other forms of a word (``close``, ``closed``), short names,
    names with different first letters, and those that differ in a short part (``pos_x``, ``pos_y``) are names of their
    own.
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
