"""Collect who can make a belief true in a program, and who reads it, with what is known of the values.

>>> from jacaros.agents.language.loader import load_program
>>> program, _ = load_program("robot.asl", "mode(idle). +!go : mode(M) <- -+mode(3); .send(bob, tell, at(home)).")
>>> [flow] = flows_of([program], {})
>>> [(each.how, each.values[0].kind) for each in flow.adders["mode"]]
[('fact', 'atom'), ('step', 'number')]
>>> [(each.how, each.key) for each in flow.readers]
[('condition', ('mode', 1))]
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final, NamedTuple

from jacaros.agents.checks.formulas import Key, conditions
from jacaros.agents.language import nodes
from jacaros.agents.language.lowering import format_term
from jacaros.agents.language.nodes import UNDECLARED, Declaration, children, form_of
from jacaros.agents.language.offers import Offer, Parameter
from jacaros.agents.terms.functions import ARITIES

ANY: Final = -1
"""A number of arguments that is not known."""


@dataclass(frozen=True, slots=True)
class Value:
    """What is known of an argument.

    Attributes:
        kind: ``number``, ``string``, ``atom``, ``list`` or ``structure``; empty: anything.
        options: the only values that it can have, as written; empty: any of its kind. Without a kind, some of them.
        unit: of a number, in words: ``degrees``, ``percent``, ``0 to 1``; empty if unknown.
        whole: whether a number has no decimals.
    """

    kind: str = ""
    options: tuple[str, ...] = ()
    unit: str = ""
    whole: bool = False

    def fits(self, other: "Value") -> bool:
        """Return whether both may be the same value."""
        if not self.kind or not other.kind:
            return True
        apart = self.options and other.options and set(self.options).isdisjoint(other.options)
        return self.kind == other.kind and not apart


UNKNOWN: Final = Value()


@dataclass(frozen=True, slots=True)
class Adder:
    """What can make a belief true, or cause its event.

    Attributes:
        how: ``fact``, ``rule``, ``step``, ``message``, ``answer``, ``plan`` (for a test goal), ``offer`` (callers outside
            tell it), ``property`` or ``signal``.
        size: number of arguments; None: any.
        values: what is known of them.
        literal: where a program says so.
        rule: whose conclusion it is.
        usage: a property or signal with names for its values.
    """

    how: str
    size: int | None
    values: tuple[Value, ...] = ()
    literal: nodes.Literal | None = None
    rule: nodes.Rule | None = None
    usage: str = ""


@dataclass(frozen=True, slots=True)
class Reader:
    """What asks for a belief, or reacts to its event.

    Attributes:
        how: ``condition``, ``event`` (of a plan or ``.wait``), ``deletion``, or ``belief`` or ``question`` of an offer.
        clause: the plan, rule or goal that it is in.
        sign: ``+`` or ``-`` of an event.
        denied: whether it is below a ``not``.
    """

    how: str
    literal: nodes.Literal
    clause: nodes.Node
    sign: str = ""
    denied: bool = False

    @property
    def key(self) -> Key:
        """Name and number of arguments."""
        return key_of(self.literal)


@dataclass
class ProgramFlow:
    """The beliefs of one program with its includes; those of other namespaces than the default one are left out.

    Attributes:
        adders: what gives the agent beliefs, by name.
        told: what gives them to other agents.
        removed: names of beliefs that it removes or replaces; "" if it removes any belief.
        readers: in source order for each clause.
        mentioned: names of other terms that are computed with or passed on, so they may become beliefs unseen.
        said, spelled: words of strings that are not only printed; words of strings that may be read as terms.
        is_open: beliefs, plans or agents come from elsewhere at run time.
        tells_unseen: messages may tell other agents anything.
        actions: actions of the environment, with their plans.
        texts: strings in `tell` messages, which agents refuse.
        files: the program's own files.
    """

    adders: dict[str, list[Adder]] = field(default_factory=dict)
    told: dict[str, list[Adder]] = field(default_factory=dict)
    removed: set[str] = field(default_factory=set)
    readers: list[Reader] = field(default_factory=list)
    mentioned: set[Key] = field(default_factory=set)
    said: set[str] = field(default_factory=set)
    spelled: set[str] = field(default_factory=set)
    is_open: bool = False
    tells_unseen: bool = False
    actions: list[tuple[nodes.Node, nodes.Literal]] = field(default_factory=list)
    texts: list[nodes.String] = field(default_factory=list)
    files: set[str] = field(default_factory=set)

    def add(self, other: "ProgramFlow") -> None:
        """Add the flow of a further clause."""
        for name, added in vars(other).items():
            own = getattr(self, name)
            if isinstance(added, dict):
                for belief, adders in added.items():
                    own.setdefault(belief, []).extend(adders)
            elif isinstance(added, list):
                own += added
            else:
                setattr(self, name, own | added)


def flows_of(
    programs: Iterable[nodes.Program],
    actions: Mapping[str, Declaration],
    observables: Mapping[str, Sequence[Adder]] | None = None,
) -> list[ProgramFlow]:
    """Return the flows of programs. A clause of a library that they share is looked at once.

    Args:
        programs: the programs with their includes.
        actions: the internal actions by name.
        observables: properties and signals whose values variables may have.
    """
    collector, flows = _Collector(actions, observables or {}), []
    shared: dict[int, ProgramFlow] = {}
    for program in programs:
        flow = ProgramFlow()
        facts = set(map(id, program.beliefs))
        for clause in (*program.beliefs, *program.goals, *program.plans):
            if is_own(clause):
                collector.collect(flow, clause, id(clause) in facts)
                continue
            if id(clause) not in shared:
                part = shared[id(clause)] = ProgramFlow()
                collector.collect(part, clause, id(clause) in facts)
            flow.add(shared[id(clause)])
        for offer in program.offers:
            collector.collect_offer(flow, offer)
        flows.append(flow)
    return flows


def key_of(literal: nodes.Literal) -> Key:
    """Name and number of arguments of a belief; the name of a strongly negated one begins with ``~``."""
    name = literal.functor.strip("'")
    return (f"~{name}" if literal.negated else name), len(literal.arguments)


def is_own(node: nodes.Node) -> bool:
    """Return whether a node is in a file of the project, not in a library of JaCaROS."""
    return node.span is not None and not node.span.file.name.startswith("$")


def source_of(literal: nodes.Literal) -> str:
    """Return the source that a literal asks for, such as ``percept``; empty if it asks for any."""
    for each in literal.annotations.items if literal.annotations is not None else ():
        if isinstance(each, nodes.Literal) and each.functor == "source" and len(each.arguments) == 1:
            source = each.arguments[0]
            if isinstance(source, nodes.Literal) and not source.arguments:
                return key_of(source)[0]
    return ""


@dataclass(frozen=True)
class Flow:
    """The beliefs of all agents of a project.

    Attributes:
        programs: the programs of its agents.
        observables: the properties and signals of its artifacts, by name.
    """

    programs: Sequence[ProgramFlow]
    observables: Mapping[str, Sequence[Adder]] = field(default_factory=dict)

    @property
    def is_open(self) -> bool:
        """Whether beliefs, plans or agents come from elsewhere at run time."""
        return any(each.is_open for each in self.programs)

    def adders(self, program: ProgramFlow) -> dict[str, list[Adder]]:
        """Return everything that can give an agent beliefs, by name.

        Agents with a file in common count as one: a belief that one of them has may be what its plans are for.
        """
        kin = [each for each in self.programs if each is program or each.files & program.files]
        tables = [each.adders for each in kin] + [each.told for each in self.programs]
        found: dict[str, list[Adder]] = {}
        for table in (*tables, self.observables):
            for name, adders in table.items():
                found.setdefault(name, []).extend(adders)
        return found


# Values of arguments.


def value_of(term: nodes.Node, variables: Mapping[str, Value]) -> Value:
    """Return what is known of a term."""
    match term:
        case nodes.Variable(annotations=None, negated=False):
            return variables.get(term.name, UNKNOWN)
        case nodes.Number():
            return Value("number", (format_term(term),))
        case nodes.Arithmetic():
            return Value("number")
        case nodes.FunctionCall() if term.name in ARITIES:
            return Value("number")
        case nodes.String():
            return Value("string", (format_term(term),))
        case nodes.ListTerm():
            return Value("list")
        case nodes.Literal(negated=False, namespace=None, annotations=None):
            name, size = key_of(term)
            return Value("structure", (f"{name}/{size}",)) if size else Value("atom", (name,))
    return UNKNOWN


def _declared(parameter: Parameter) -> Value:
    """Return what the kind of an argument of an offer says of its value."""
    match parameter.kind:
        case "any":
            return UNKNOWN
        case "boolean":
            return Value("atom", ("true", "false"))
        case "integer":
            return Value("number", whole=True)
        case "string":
            return Value("string", tuple([format_term(nodes.String(each)) for each in parameter.choices]))
    return Value(parameter.kind, parameter.choices)


def merged(values: Iterable[Value]) -> Value:
    """Return what is known of a value that is one of these."""
    found = list(values)
    kinds, units = {each.kind for each in found}, {each.unit for each in found}
    if len(kinds) != 1:
        return UNKNOWN
    options = {option: None for each in found for option in each.options}
    is_any = any(not each.options for each in found)
    unit = units.pop() if len(units) == 1 else ""
    return Value(kinds.pop(), () if is_any else tuple(options), unit, all(each.whole for each in found))


Columns = dict[tuple[Key, int], Value]
"""What is known of an argument of a belief, by the belief's key and the argument's place."""


def variables_of(
    clause: nodes.Node, known: Mapping[str, Sequence[Adder]], columns: Columns | None = None
) -> dict[str, Value]:
    """Return what is known of the variables of a clause, from the beliefs that it reads.

    A variable that two beliefs give different kinds or units is unknown.

    Args:
        clause: a clause of the program.
        known: all that can give beliefs, by name.
        columns: what is known already, for several clauses with the same *known*.
    """
    found: dict[str, Value] = {}
    columns = {} if columns is None else columns
    for literal in _given(clause):
        key = key_of(literal)
        adders = of_size(known, key)
        for place, argument in enumerate(literal.arguments if adders else ()):
            if not isinstance(argument, nodes.Variable) or argument.annotations is not None:
                continue
            if (key, place) not in columns:
                columns[key, place] = merged(place_of(each, place) for each in adders)
            value = columns[key, place]
            before = found.setdefault(argument.name, value)
            if before != value:
                found[argument.name] = merged((before, value))
    return found


def of_size(adders: Mapping[str, Sequence[Adder]], key: Key) -> list[Adder]:
    """Return what can give beliefs of this name and number of arguments."""
    return [each for each in adders.get(key[0], ()) if each.size in (None, key[1])]


def place_of(adder: Adder, place: int) -> Value:
    """Return what is known of one of its values."""
    return adder.values[place] if place < len(adder.values) else UNKNOWN


_SCOPES: Final = (nodes.Not, nodes.InternalAction, nodes.PlanTerm, nodes.RuleTerm, nodes.For, nodes.While)
"""What binds variables only within, if at all."""


def _given(clause: nodes.Node) -> Iterator[nodes.Literal]:
    """Yield the belief literals that give the variables of a clause their values."""
    stack: list[tuple[nodes.Node, bool]] = [(clause, False)]
    while stack:
        node, asked = stack.pop()
        if isinstance(node, nodes.Trigger):
            if node.kind == "" and isinstance(node.literal, nodes.Literal):
                yield node.literal
        elif isinstance(node, nodes.Literal) and asked:
            if node.namespace is None:
                yield node
        elif isinstance(node, nodes.And | nodes.Or):
            stack += [(each, asked) for each in node.operands]
        elif not isinstance(node, _SCOPES):
            asked_here = conditions(node)
            stack += [(each, any(each is one for one in asked_here)) for each in children(node)]


# Collecting.

_WORD: Final = re.compile(r"\w+")
_READABLE: Final = re.compile(r"\w\(|<-|^\s*[-+!?]")
"""Text that may be read as a term, goal or plan."""
_TELLS, _ASKS = ("tell", "signal"), ("askOne", "askAll")


class _At(NamedTuple):
    """Where a node is.

    Attributes:
        asked: it is a condition.
        denied: it is below ``not``.
        passed: a term here may become a belief unseen; values of beliefs and printed terms may not.
        read: a string here may be read as a term.
    """

    asked: bool = False
    denied: bool = False
    passed: bool = True
    read: bool = False


class _Collector:
    """Collects the flow of one clause after the other."""

    def __init__(
        self, actions: Mapping[str, Declaration], observables: Mapping[str, Sequence[Adder]]
    ) -> None:
        self.found = ProgramFlow()
        self._actions, self._observables = actions, observables
        self._clause: nodes.Node = nodes.Number(0.0)
        self._variables: dict[str, Value] | None = None
        self._stack: list[tuple[nodes.Node, _At]] = []

    def collect(self, found: ProgramFlow, clause: nodes.Node, is_belief: bool) -> None:
        """Collect what a plan, a rule, an initial belief or an initial goal adds to a flow."""
        self.found, self._clause, self._variables = found, clause, None
        if clause.span is not None and is_own(clause):
            self.found.files.add(clause.span.file.name)
        if not isinstance(clause, nodes.Literal):
            self._push(_At(), clause)
        elif is_belief:
            self._add(self.found.adders, "fact", clause)
        else:
            self._push(_At(), *_below(clause))
        while self._stack:
            node, at = self._stack.pop()
            self._look(node, at)

    def collect_offer(self, found: ProgramFlow, offer: Offer) -> None:
        """Collect what callers outside may tell, and what they may look at."""
        literal = form_of(offer)
        self.found, self._clause = found, literal
        if offer.what == "tell":
            values = tuple(map(_declared, offer.parameters))
            adder = Adder("offer", len(values), values, literal)
            found.adders.setdefault(offer.name, []).append(adder)
            found.removed.add(offer.name)
        elif offer.what in ("belief", "question"):
            self._read(offer.what, literal)

    def _push(self, at: _At, *below: nodes.Node) -> None:
        self._stack += [(node, at) for node in reversed(below)]

    def _look(self, node: nodes.Node, at: _At) -> None:
        match node:
            case nodes.Trigger():
                self._react(node)
            case nodes.BeliefChange():
                self._change(node)
            case nodes.InternalAction():
                self._call(node, at)
            case nodes.Achieve(goal=nodes.Literal() as goal):
                self._push(_At(), *_below(goal))
            case nodes.ExternalAction(action=nodes.Literal() as action):
                self.found.actions.append((self._clause, action))
                self._push(_At(), *_below(action))
            case nodes.Literal():
                self._literal(node, at)
            case nodes.String():
                self._string(node, at)
            case nodes.FunctionCall(name=".count"):
                self._push(at._replace(asked=True), *node.arguments)
            case nodes.Rule():
                self._add(self.found.adders, "rule", node.head, node)
                self._push(_At(asked=True), node.body)
            case nodes.Relation(operator="=..", right=nodes.ListTerm(items=items)):
                # Of any size.
                self.found.mentioned |= {
                    (key_of(each)[0], ANY) for each in items[:1] if isinstance(each, nodes.Literal)
                }
                self._push_children(node, at)
            case nodes.Not():
                self._push(at._replace(denied=True), node.operand)
            case nodes.And() | nodes.Or():
                self._push(at, node.left, node.right)
            case nodes.Plan(label=label) if isinstance(label, nodes.Literal):
                self._push(_At(passed=False), *_below(label))
                self._push_children(node, at, label)
            case _:
                self._push_children(node, at)

    def _push_children(self, node: nodes.Node, at: _At, without: nodes.Node | None = None) -> None:
        self._push_parts(node, [each for each in children(node) if each is not without], at)

    def _push_parts(self, node: nodes.Node, below: Sequence[nodes.Node], at: _At) -> None:
        plain = at._replace(asked=False) if at.asked else at
        if not (asked := conditions(node)):
            self._stack += [(each, plain) for each in reversed(below)]
            return
        self._stack += [
            (each, plain._replace(asked=True) if any(each is one for one in asked) else plain)
            for each in reversed(below)
        ]

    def _react(self, trigger: nodes.Trigger) -> None:
        literal = trigger.literal
        if not isinstance(literal, nodes.Literal):
            return
        if trigger.kind == "" and trigger.operator in "+-":
            self._read("event", literal, trigger.operator)
        elif trigger.kind == "?" and trigger.operator == "+":
            self._add(self.found.adders, "plan", literal)
        self._push(_At(passed=False), *_below(literal))

    def _change(self, change: nodes.BeliefChange) -> None:
        operand = change.operand
        if not isinstance(operand, nodes.Literal):
            self.found.is_open |= isinstance(operand, nodes.Variable)
            self._push(_At(), operand)
            return
        if "-" in change.operator:
            self.found.removed.add(key_of(operand)[0])
        if "+" in change.operator:
            self._add(self.found.adders, "step", operand)
        else:
            self._read("deletion", operand)
        self._push(_At(passed=False), *_below(operand))

    def _literal(self, literal: nodes.Literal, at: _At) -> None:
        if at.asked and literal.namespace is None:
            if literal.functor in ("true", "false") and not literal.arguments:
                return
            self._read("condition", literal, denied=at.denied)
            at = _At(passed=False)
        elif at.passed and is_own(literal):
            self.found.mentioned.add(key_of(literal))
        self._push_parts(literal, list(_below(literal)), at)

    def _string(self, string: nodes.String, at: _At) -> None:
        if at.passed and is_own(string):
            words = _WORD.findall(string.value)
            self.found.said.update(words)
            if at.read or _READABLE.search(string.value):
                self.found.spelled.update(words)

    # Internal actions.

    def _call(self, call: nodes.InternalAction, at: _At) -> None:
        action = self._actions.get(call.name, UNDECLARED)
        self.found.is_open |= action.brings_in
        if call.name == ".abolish" and nodes.Variable in map(type, call.arguments):
            self.found.removed.add("")
        place, arguments = action.performative, list(call.arguments)
        if place is not None and len(arguments) > place + 1:
            self._tell(arguments[place], arguments[place + 1], bool(arguments[place + 2 :]))
            arguments = arguments[:place] + arguments[place + 2 :]
        if action.condition is not None and len(arguments) > action.condition:
            self._push(_At(asked=True), arguments.pop(action.condition))
        below = _At(passed=not action.prints, read=call.name == ".term2string" or action is UNDECLARED)
        for each in arguments:
            if action.awaits and not isinstance(each, nodes.BodyTerm):
                self._push(_At(asked=True), each)
            elif action.awaits:
                self._await(each)
            elif call.name == ".abolish" and isinstance(each, nodes.Literal):
                self.found.removed.add(key_of(each)[0])
                self._read("deletion", each)
            else:
                self._push(below, each)

    def _await(self, awaited: nodes.Node) -> None:
        """Note the event ``{+b}`` or ``{-b}`` that a ``.wait`` waits for: it parses as a belief change."""
        for step in awaited.body.steps if isinstance(awaited, nodes.BodyTerm) else ():
            if isinstance(step, nodes.BeliefChange) and isinstance(step.operand, nodes.Literal):
                self._read("event", step.operand, step.operator)
                self._push(_At(passed=False), *_below(step.operand))

    def _tell(self, performative: nodes.Node, content: nodes.Node, has_answer: bool) -> None:
        word = performative.functor if isinstance(performative, nodes.Literal) else ""
        contents = content.items if isinstance(content, nodes.ListTerm) else (content,)
        for each in contents:
            if word == "untell":
                self.found.removed.add(key_of(each)[0] if isinstance(each, nodes.Literal) else "")
            if isinstance(each, nodes.String) and word in _TELLS and not has_answer:
                self.found.texts.append(each)
            elif not isinstance(each, nodes.Literal):
                self.found.tells_unseen |= isinstance(each, nodes.Variable) and word in ("", *_TELLS)
                self._push(_At(read=True), each)
            elif word in _TELLS or not word:
                self._add(self.found.told, "message", each)
            elif word in _ASKS and not has_answer:
                self._add(self.found.adders, "answer", each)
            else:
                self._push(_At(), *((each,) if word in _ASKS else _below(each)))
        self.found.tells_unseen |= word == "tellHow" and isinstance(content, nodes.Variable)

    # Adders and readers.

    def _read(self, how: str, literal: nodes.Literal, sign: str = "", denied: bool = False) -> None:
        if literal.namespace is None:
            self.found.readers.append(Reader(how, literal, self._clause, sign, denied))

    def _add(
        self, table: dict[str, list[Adder]], how: str, literal: nodes.Node, rule: nodes.Rule | None = None
    ) -> None:
        if not isinstance(literal, nodes.Literal) or literal.namespace is not None:
            self.found.is_open |= isinstance(literal, nodes.Literal | nodes.Variable) and isinstance(
                literal.namespace, nodes.Variable
            )
            return
        if self._variables is None:
            self._variables = variables_of(self._clause, self._observables)
        known = {} if how in ("rule", "plan") else self._variables
        values = tuple([value_of(each, known) for each in literal.arguments])
        name, size = key_of(literal)
        table.setdefault(name, []).append(Adder(how, size, values, literal, rule))
        self._push(_At(passed=False), *_below(literal))


def _below(literal: nodes.Literal) -> Iterator[nodes.Node]:
    """Yield the arguments and the annotations of a literal."""
    yield from literal.arguments
    if literal.annotations is not None:
        yield from literal.annotations.items
