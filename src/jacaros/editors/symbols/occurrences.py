"""Find the names in a program: what each means, and what is done with it.

>>> from jacaros.agents.language.loader import load_program
>>> program, _ = load_program("r.asl", "at(home). +!go(R) : at(X) <- move(R); -+at(R).")
>>> for each in occurrences_of(program, {}):
...     print(each.symbol, each.role, each.span.column) if each.symbol.kind != "variable" else None
at/1 defines 1
!go/1 handles 13
at/1 asks 21
move/1 calls 30
at/1 adds 41
"""

import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from typing import Final

from jacaros.agents.checks.formulas import conditions
from jacaros.agents.checks.goals import ON_GOALS
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import AslError, SourceFile, Span
from jacaros.agents.language.loader import parse_literals
from jacaros.agents.language.nodes import UNDECLARED, Declaration, children
from jacaros.editors.symbols.model import Kind, Occurrence, Role, Symbol
from jacaros.runtime.mas.project.reading import reader_of

_BEFORE_NAME: Final = re.compile(r"~?\s*(?:\w*\s*::\s*)?~?\s*")
"""What may be written before the name of a literal: a namespace, and a strong negation."""
_MESSAGES: Final[Mapping[str, tuple[Kind, Role]]] = {
    "tell": ("belief", "tells"),
    "signal": ("belief", "tells"),
    "untell": ("belief", "removes"),
    "askOne": ("belief", "asks"),
    "askAll": ("belief", "asks"),
    "achieve": ("goal", "calls"),
    "unachieve": ("goal", "removes"),
}
"""What the content of a message is, by performative."""
_FIRST: Final[Mapping[str, tuple[Kind, Role]]] = {
    **dict.fromkeys(ON_GOALS, ("goal", "asks")),
    ".abolish": ("belief", "removes"),
    ".remove_plan": ("plan", "mentions"),
}
"""What the first argument of an internal action is."""
_Place = tuple[nodes.Node, bool]
"""A node, and whether it is used as a condition."""


def occurrences_of(
    program: nodes.Program, actions: Mapping[str, Declaration], name: str = ""
) -> Iterator[Occurrence]:
    """Yield the occurrences of all names in a program and its includes, clause by clause.

    Args:
        program: the program.
        actions: internal actions by name.
        name: of the program; local namespaces are its own.
    """
    seeker = _Seeker(actions, name)
    for belief in program.beliefs:
        yield from seeker.clause(belief, "belief")
    for goal in program.goals:
        yield from seeker.clause(goal, "goal")
    for plan in program.plans:
        yield from seeker.clause(plan)
    for offer in program.offers:
        if offer.span is not None:
            symbol = Symbol("goal" if offer.what == "goal" else "belief", offer.name, len(offer.parameters))
            names = tuple([each.name[:1].upper() + each.name[1:] for each in offer.parameters])
            found = _word_in(offer.span, offer.name)
            if found is not None:
                yield Occurrence(symbol, "offers", found, offer.span, names)


def declared_in(file: SourceFile) -> Iterator[Occurrence]:
    """Yield the occurrences in the beliefs and goals that a project file gives its agents."""
    seeker = _Seeker({}, file.name)
    for agent in reader_of(file, []).read().agents:
        pieces: list[tuple[Kind, tuple[str, Span]]] = [
            *(("belief", each) for each in agent.beliefs),
            *(("goal", each) for each in agent.goals),
        ]
        for kind, (text, place) in pieces:
            quoted = file.lines[place.line - 1][place.column - 1 :].startswith('"')
            # The text stays where it is, so the places of its nodes are those in the file.
            padded = "\n" * (place.line - 1) + " " * (place.column - 1 + quoted) + text
            with suppress(AslError):  # the checker reports it
                for literal in parse_literals(padded, file.name):
                    for each in seeker.clause(literal, kind):
                        yield each._replace(span=each.span._replace(file=file), clause=place)


class _Seeker:
    """Walks the clauses of one program."""

    def __init__(self, actions: Mapping[str, Declaration], name: str) -> None:
        self._actions, self._name = actions, name
        self._clause: Span | None = None
        self._scope = ""
        self._found: list[Occurrence] = []
        self._stack: list[_Place] = []

    def clause(self, clause: nodes.Node, kind: Kind = "belief") -> list[Occurrence]:
        """Return the occurrences in a plan, a rule, or an initial belief or goal."""
        self._clause, self._found = clause.span, []
        self._scope = scope_of(clause.span) if clause.span is not None else ""
        if isinstance(clause, nodes.Literal):
            self._note(kind, clause, "defines" if kind == "belief" else "calls")
            self._push(*children(clause))
        else:
            self._push(clause)
        while self._stack:
            node, asked = self._stack.pop()
            if type(node) is nodes.Variable:  # the most frequent kind
                if not node.unnamed:
                    self._note_symbol(Symbol("variable", node.name, 0, self._scope), node, "mentions")
                if node.annotations is not None:
                    self._push(node.annotations)
            else:
                self._look(node, asked)
        return self._found

    def _push(self, *below: nodes.Node, asked: bool = False) -> None:
        self._stack += [(each, asked) for each in reversed(below)]

    def _look(self, node: nodes.Node, asked: bool) -> None:
        match node:
            case nodes.Plan(label=nodes.Literal() as label):
                self._literal("plan", label, "defines")
                self._below(node, without=label)
            case nodes.Trigger(kind=kind, literal=nodes.Literal() as literal):
                self._literal("goal" if kind == "!" else "belief", literal, "handles")
            case nodes.Achieve(goal=nodes.Literal() as goal):
                self._literal("goal", goal, "calls")
            case nodes.BeliefChange(operator=sign, operand=nodes.Literal() as operand):
                self._literal("belief", operand, "adds" if "+" in sign else "removes")
            case nodes.ExternalAction(action=nodes.Literal() as action):
                self._literal("operation", action, "calls")
            case nodes.InternalAction():
                self._call(node)
            case nodes.FunctionCall():
                self._note_symbol(Symbol("internal action", node.name), node, "calls")
                self._push(*node.arguments, asked=node.name == ".count")
            case nodes.Rule():
                self._literal("belief", node.head, "defines")
                self._push(node.body, asked=True)
            case nodes.And() | nodes.Or() | nodes.Not():
                self._push(*node.operands, asked=asked)
            case nodes.Literal() if asked and not (node.functor in ("true", "false") and not node.arguments):
                self._literal("belief", node, "asks")
            case nodes.Number() | nodes.String():
                return
            case _:
                self._below(node)

    def _below(self, node: nodes.Node, without: nodes.Node | None = None) -> None:
        asked = set(map(id, conditions(node)))  # none for most nodes
        self._stack += [
            (each, id(each) in asked) for each in reversed(list(children(node))) if each is not without
        ]

    def _literal(self, kind: Kind, literal: nodes.Literal, role: Role) -> None:
        self._note(kind, literal, role)
        self._push(*children(literal))

    def _call(self, call: nodes.InternalAction) -> None:
        self._note_symbol(Symbol("internal action", call.name), call, "calls")
        action, arguments = self._actions.get(call.name, UNDECLARED), list(call.arguments)
        place = action.performative
        if place is not None and len(arguments) > place + 1:
            performative, content = arguments[place : place + 2]
            word = performative.functor if isinstance(performative, nodes.Literal) else ""
            if word in _MESSAGES:
                arguments[place + 1 : place + 2] = []
                self._message(content, *_MESSAGES[word])
        if action.condition is not None and len(arguments) > action.condition:
            self._push(arguments.pop(action.condition), asked=True)
        if call.name in _FIRST and arguments and isinstance(first := arguments[0], nodes.Literal):
            self._literal(_FIRST[call.name][0], first, _FIRST[call.name][1])
            del arguments[0]
        for each in arguments:
            if action.awaits and isinstance(each, nodes.BodyTerm):
                self._await(each)
            else:
                self._push(each, asked=action.awaits)

    def _message(self, content: nodes.Node, kind: Kind, role: Role) -> None:
        for each in content.items if isinstance(content, nodes.ListTerm) else (content,):
            if isinstance(each, nodes.Literal):
                self._literal(kind, each, role)
            else:
                self._push(each)

    def _await(self, awaited: nodes.BodyTerm) -> None:
        """Note the event ``{+b}`` that a ``.wait`` waits for: it parses as a belief change."""
        for step in awaited.body.steps:
            if isinstance(step, nodes.BeliefChange) and isinstance(step.operand, nodes.Literal):
                self._literal("belief", step.operand, "handles")
            else:
                self._push(step)

    def _note(self, kind: Kind, literal: nodes.Literal, role: Role) -> None:
        space = literal.namespace
        if isinstance(space, nodes.Variable) or kind in ("operation", "plan"):
            space = None
        elif space is not None and "#" in space:
            space = f"{space} of {self._name}"
        names = tuple(map(_variable_name, literal.arguments))
        size = 0 if kind == "plan" else len(names)
        self._note_symbol(Symbol(kind, literal.functor, size, space or ""), literal, role, names)

    def _note_symbol(
        self, symbol: Symbol, node: nodes.Node, role: Role, arguments: tuple[str, ...] = ()
    ) -> None:
        if node.span is None or self._clause is None:
            return
        span = _name_in(node.span, symbol.name)
        if span is not None:  # not made by a pattern
            self._found.append(Occurrence(symbol, role, span, self._clause, arguments))


def scope_of(clause: Span) -> str:
    """Return the scope of the variables of a clause."""
    return f"{clause.file.name}:{clause.line}:{clause.column}"


def _variable_name(argument: nodes.Node) -> str:
    return argument.name if type(argument) is nodes.Variable and not argument.unnamed else ""


def _name_in(span: Span, name: str) -> Span | None:
    """Return where a node's name is written; None if the program does not say it there."""
    lines = span.file.lines
    if not 0 < span.line <= len(lines):
        return None
    line = lines[span.line - 1]
    start = span.column - 1
    if not line.startswith(name, start):
        before = _BEFORE_NAME.match(line, start)
        start = before.end() if before is not None else start
        if not line.startswith(name, start):
            return None
    return Span(span.file, span.line, start + 1, span.line, start + 1 + len(name))


def _word_in(span: Span, word: str) -> Span | None:
    """Return where a word is first written in a directive, after the keyword."""
    for number in range(span.line, span.end_line + 1):
        line = span.file.lines[number - 1]
        start = span.column - 1 if number == span.line else 0
        found = re.compile(rf"(?<=[,\s]){re.escape(word)}\b").search(line, start)
        if found is not None:
            return Span(span.file, number, found.start() + 1, number, found.end() + 1)
    return None
