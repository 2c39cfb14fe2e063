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


Key = tuple[str, int]
"""Name and number of arguments."""


@dataclass
class Beliefs:
    """The names of beliefs in a program.

    Attributes:
        asked: beliefs that plans react to and conditions ask for, by name.
        made_as: beliefs that the program gives itself and others.
        mentioned: all other names in it, and words of strings: they may become beliefs in ways that are not visible.
        is_open: beliefs, plans or agents come from elsewhere at run time.
        events: events that plans and ``.wait`` react to, sign and belief; default namespace only, without strong negation.
        concluded, mentioned_as: the conclusions of rules; as `mentioned`, without words.
        said: words of strings that are not only printed.
        facts: initial beliefs, by name.
        noted: beliefs that the agent itself adds: initial ones, and those of steps without a source annotation.
        brought: beliefs that come in other ways: from messages, with a source annotation, from plans for tests, or in
            ways that are not visible, because they appear in other terms.
    """

    asked: dict[str, list[nodes.Literal]] = field(default_factory=dict)
    mentioned: set[str] = field(default_factory=set)
    is_open: bool = False
    events: dict[Key, list[tuple[str, nodes.Literal]]] = field(default_factory=dict)
    made_as: set[Key] = field(default_factory=set)
    concluded: dict[Key, nodes.Rule] = field(default_factory=dict)
    mentioned_as: set[Key] = field(default_factory=set)
    said: set[str] = field(default_factory=set)
    facts: dict[str, list[nodes.Literal]] = field(default_factory=dict)
    noted: set[Key] = field(default_factory=set)
    brought: set[Key] = field(default_factory=set)

    @property
    def made(self) -> set[str]:
        """Names that the program gives to its own beliefs and to those of others."""
        return {name for name, _ in (*self.made_as, *self.concluded)}


def beliefs_of(program: nodes.Program, actions: Mapping[str, Declaration]) -> Beliefs:
    """Collect the beliefs of a program and its includes; *actions* are the internal actions by name."""
    found = Beliefs()
    heads: set[int] = set()
    for belief in program.beliefs:
        head = belief.head if isinstance(belief, nodes.Rule) else belief
        heads.add(id(head))
        if isinstance(belief, nodes.Rule):
            found.concluded.setdefault(key_of(belief.head), belief)
        else:
            found.made_as.update(_keys(belief))
            found.facts.setdefault(_name(belief), []).append(belief)
            _note(belief, found)
    asked: set[int] = set()
    for clause in (*clauses(program), *program.goals):
        for node, is_asked in in_order(clause):
            if isinstance(node, nodes.InternalAction):
                _look_at_call(node, actions.get(node.name, UNDECLARED), asked, found)
            else:
                _look_at(node, is_asked, asked, found)
    for plan in program.plans:
        _react(plan, found)
    printed: set[int] = set()
    noted = _notes(program)
    for node in walk(program.beliefs, program.goals, program.plans):
        if isinstance(node, nodes.InternalAction) and actions.get(node.name, UNDECLARED).prints:
            printed.update(map(id, walk(node.arguments)))
        elif isinstance(node, nodes.Literal) and id(node) not in asked:
            found.mentioned.add(_name(node))
            if id(node) not in heads and id(node) not in printed:
                found.mentioned_as.add(key_of(node))
                if id(node) not in noted:
                    found.brought.add(key_of(node))
        elif isinstance(node, nodes.String):
            words = _WORD.findall(node.value)
            found.mentioned.update(words)
            if id(node) not in printed:
                found.said.update(words)
    return found


def _react(plan: nodes.Plan, found: Beliefs) -> None:
    """Note the belief events that trigger a plan and its sub-plans."""
    if plan.trigger.kind == "" and plan.trigger.operator in "+-":
        _note_event(plan.trigger.operator, plan.trigger.literal, found)
    for inner in plan.subplans:
        _react(inner, found)


def _note_event(sign: str, literal: nodes.Node, found: Beliefs) -> None:
    if isinstance(literal, nodes.Literal) and literal.namespace is None and not literal.negated:
        found.events.setdefault(key_of(literal), []).append((sign, literal))


def _awaited(wait: nodes.InternalAction) -> Iterator[nodes.BeliefChange]:
    """Yield the event ``{+b}`` or ``{-b}`` that a ``.wait`` waits for: it parses as a belief change."""
    for argument in wait.arguments:
        if isinstance(argument, nodes.BodyTerm):
            yield from (step for step in argument.body.steps if isinstance(step, nodes.BeliefChange))


def _look_at(node: nodes.Node, is_asked: bool, asked: set[int], found: Beliefs) -> None:
    if isinstance(node, nodes.Trigger):
        if node.kind == "" and node.operator in "+-":
            _ask(node.literal, asked, found)
        elif node.kind == "?":
            _make(node.literal, found)
            found.brought.update(_keys(node.literal))
    elif isinstance(node, nodes.BeliefChange):
        if id(node) in asked:
            return
        found.is_open = found.is_open or isinstance(node.operand, nodes.Variable)
        if isinstance(node.operand, nodes.Literal) and "+" in node.operator:
            _make(node.operand, found)
            _note(node.operand, found)
    elif is_asked:
        _ask(node, asked, found)


def _look_at_call(node: nodes.InternalAction, action: Declaration, asked: set[int], found: Beliefs) -> None:
    if action.awaits:
        for change in _awaited(node):
            asked.add(id(change))
            _ask(change.operand, asked, found)
            _note_event(change.operator, change.operand, found)
    found.is_open = found.is_open or action.brings_in
    if action.performative is not None and node.arguments:
        _make(node.arguments[-1], found)
        found.brought.update(_keys(node.arguments[-1]))
    if action.condition is not None:
        for condition in node.arguments[action.condition :][:1]:
            for part in parts_of(condition):
                _ask(part, asked, found)


def _ask(node: nodes.Node, asked: set[int], found: Beliefs) -> None:
    """Note a literal that is asked for; beliefs of other namespaces may come from anywhere."""
    if isinstance(node, nodes.Literal) and node.namespace is None:
        asked.add(id(node))
        found.asked.setdefault(_name(node), []).append(node)


def _make(term: nodes.Node, found: Beliefs) -> None:
    """Note a belief that is added, or a list of them."""
    found.made_as.update(_keys(term))


def _notes(program: nodes.Program) -> set[int]:
    """Return the literals that steps add or delete."""
    steps = walk(program.plans)
    return {id(step.operand) for step in steps if isinstance(step, nodes.BeliefChange)}


def _note(belief: nodes.Literal, found: Beliefs) -> None:
    """Note a belief whose source is the agent itself, unless its annotations may name another one."""
    (found.noted if belief.annotations is None else found.brought).add(key_of(belief))


def source_of(literal: nodes.Literal) -> str:
    """Return the source that a literal asks for, such as ``percept``; empty if it asks for any."""
    items = literal.annotations.items if literal.annotations is not None else ()
    for each in items:
        if isinstance(each, nodes.Literal) and each.functor == "source" and len(each.arguments) == 1:
            source = each.arguments[0]
            if isinstance(source, nodes.Literal) and not source.arguments:
                return _name(source)
    return ""


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


def _keys(term: nodes.Node) -> Iterator[Key]:
    for node in term.items if isinstance(term, nodes.ListTerm) else (term,):
        if isinstance(node, nodes.Literal):
            yield key_of(node)


def key_of(literal: nodes.Literal) -> Key:
    """Name and number of arguments of a belief."""
    return _name(literal), len(literal.arguments)


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
