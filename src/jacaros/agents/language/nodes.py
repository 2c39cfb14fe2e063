"""The syntax tree of AgentSpeak: plain frozen data, each node with its place in the source.

Terms, logical formulae and body formulae share `Term`, as plans and conditions may be arguments.

>>> replace(Literal("at", (Number(1.0),)), functor="near").functor
'near'
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator
from dataclasses import KW_ONLY, dataclass, field, fields
from functools import cached_property
from typing import Any, ClassVar, Final, TypeVar, dataclass_transform

from jacaros.agents.language.diagnostics import Span
from jacaros.agents.language.offers import Offer
from jacaros.agents.terms.values import Term as Value


@dataclass_transform(frozen_default=True)
class _NodeType(type):
    """Give a class slots and ``__init__`` for its annotations, as `dataclass` does.

    Thirty dataclasses would take a fifth of a program's start-up time; these take a millisecond.
    """

    def __new__(cls, name: str, bases: tuple[type, ...], body: dict[str, Any]) -> _NodeType:
        parts = [
            part
            for part, kind in body.get("__annotations__", {}).items()
            if part not in ("_", "span") and not kind.startswith("ClassVar")
        ]
        if parts:
            parameters = [f"{part}={body.pop(part)!r}" if part in body else part for part in parts]
            body["__match_args__"] = tuple(parts)
            exec(
                f"def __init__(self, {', '.join(parameters)}, *, span=None):\n"
                + "".join(f"    self.{part} = {part}\n" for part in (*parts, "span"))
                + f"def parts(self): return ({''.join(f'self.{part}, ' for part in parts)})\n",
                body,
            )
            del body["__builtins__"]
        body.pop("span", None)
        body["__slots__"] = tuple(parts) if bases else ("span",)
        return super().__new__(cls, name, bases, body)


class Node(metaclass=_NodeType):
    """A node with its place in the source (None for nodes made at run time).

    Two nodes are equal if they have the same class and equal parts; the place is not compared.
    """

    __match_args__: ClassVar[tuple[str, ...]] = ()
    """The names of the parts, in source order."""

    _: KW_ONLY
    span: Span | None = None

    def parts(self) -> tuple[Any, ...]:
        """The values of the parts, in source order."""
        return ()

    def __eq__(self, other: object) -> bool:
        if other.__class__ is not self.__class__:
            return NotImplemented
        return self is other or self.parts() == other.parts()  # pyright: ignore[reportAttributeAccessIssue]

    def __hash__(self) -> int:
        return hash((self.__class__, self.parts()))

    def __reduce__(self) -> tuple[Any, ...]:
        return remade, (self.__class__, self.parts(), self.span)

    def __repr__(self) -> str:
        shown = ", ".join(f"{name}={getattr(self, name)!r}" for name in self.__match_args__)
        return f"{type(self).__name__}({shown})"


Some = TypeVar("Some", bound=Node)


def remade(kind: type[Some], parts: tuple[Any, ...], span: Span | None) -> Some:
    """Return a node of these parts."""
    return kind(*parts, span=span)


def replace(node: Some, **parts: Any) -> Some:
    """Return a copy of the node with other *parts*, or at another place (``span``)."""
    kept = dict(zip(node.__match_args__, node.parts(), strict=True))
    return type(node)(**{**kept, "span": node.span, **parts})


class Number(Node):
    """A number literal: a double, or an integer that no double is equal to (`jacaros.agents.terms.values.number`)."""

    value: float


class String(Node):
    r"""A string literal, with ``\n`` and ``\"`` already converted and no other escape."""

    value: str


class Variable(Node):
    """A variable. Every occurrence of an unnamed one (``_``, ``_X``) has its own ``name`` (``_7``)."""

    name: str
    annotations: Annotations | None = None
    namespace: str | Variable | None = None
    negated: bool = False
    unnamed: bool = False


class Annotations(Node):
    """``[a, b | T]``: the elements and the tail."""

    items: tuple[Term, ...]
    tail: Variable | None = None


class Literal(Node):
    """An atom, structure, or literal: ``ns::~f(a, b)[annots]``.

    ``functor`` keeps the quotes of a quoted atom. ``namespace`` is None for the default namespace, a name, or a
    variable; the parser has already applied namespace directives.
    """

    functor: str
    arguments: tuple[Term, ...] = ()
    negated: bool = False
    annotations: Annotations | None = None
    namespace: str | Variable | None = None


class ListTerm(Node):
    """``[a, b | T]``; ``items`` may be empty with a tail (``[|T]``)."""

    items: tuple[Term, ...]
    tail: Term | None = None


class Arithmetic(Node):
    """An arithmetic operation of two numbers, such as ``X mod 2``, or of one, ``-X`` or ``+X``."""

    operator: str
    operands: tuple[Term, ...]


class FunctionCall(Node):
    """An arithmetic function: ``math.max(X, 3)``, ``.length(L)``, ``.count(p(_))``, ``system.time``."""

    name: str
    arguments: tuple[Term, ...]


class Relation(Node):
    r"""``left op right``, such as ``X < 3`` or ``X \== Y``."""

    operator: str
    left: Term
    right: Term

    @property
    def operands(self) -> tuple[Term, ...]:
        """Both sides."""
        return self.left, self.right


class _Junction(Node):
    """Two formulae and a connective."""

    left: Term
    right: Term

    @property
    def operands(self) -> tuple[Term, ...]:
        return self.left, self.right


class And(_Junction):
    """``A & B``."""

    operator: ClassVar[str] = "&"


class Or(_Junction):
    """``A | B``."""

    operator: ClassVar[str] = "|"


class Not(Node):
    """``not F``."""

    operator: ClassVar[str] = "not"
    operand: Term

    @property
    def operands(self) -> tuple[Term, ...]:
        """The one operand."""
        return (self.operand,)


Connective = And | Or | Not
CONNECTIVES: Final[dict[str, Any]] = {kind.operator: kind for kind in (And, Or, Not)}
"""The classes of the connectives by operator."""


class InternalAction(Node):
    """``.name(args)`` or ``pkg.name(args)``; ``name`` includes the leading dot of the standard ones."""

    name: str
    arguments: tuple[Term, ...] = ()


class PlanTerm(Node):
    """``{ @l +!g : c <- b }`` as a term."""

    plan: Plan


class RuleTerm(Node):
    """``{ h :- b }`` as a term."""

    rule: Rule


class TriggerTerm(Node):
    """``{ +!g }``, ``{ -?g(X) }`` as a term (``{ +b }`` is a `BodyTerm`: a belief addition)."""

    trigger: Trigger


class BodyTerm(Node):
    """``{ a; !b }`` or ``{ }`` as a term."""

    body: Body


class Constant(Node):
    """A value without a textual form, in a tree made at run time: a shared variable, a map, a reference."""

    value: Value


Term = (
    Number
    | String
    | Variable
    | Literal
    | ListTerm
    | Arithmetic
    | FunctionCall
    | Relation
    | Not
    | And
    | Or
    | InternalAction
    | PlanTerm
    | RuleTerm
    | TriggerTerm
    | BodyTerm
)
"""Any term. ``true`` and ``false`` are `Literal`s of those names, also as formulae."""


class Achieve(Node):
    """``!g`` or, with ``separate``, ``!!g``; the goal is a Literal or a Variable."""

    goal: Literal | Variable
    separate: bool = False


class Test(Node):
    """``?q``; the formula is any condition."""

    formula: Term


class BeliefChange(Node):
    """A change of beliefs (or of plans and rules, when the operand is a PlanTerm or RuleTerm).

    ``operator`` is one of ``+ - -+ ++ -- +< +>`` as written.
    """

    operator: str
    operand: Term


class ExternalAction(Node):
    """``f(..)``: an action of the environment, with its annotations; or a bare variable as a step."""

    action: Literal | Variable


class Constraint(Node):
    """``X = f(Y)``, ``X < 3``, or an internal action: a formula as a body step."""

    formula: Relation | InternalAction


class If(Node):
    """``if (c) {..} elif (d) {..} else {..}``; an elif is an `If` alone in ``otherwise``."""

    condition: Term
    then: Body
    otherwise: Body | None = None


class While(Node):
    """``while (c) {..}``."""

    condition: Term
    body: Body


class For(Node):
    """``for (c) {..}``."""

    condition: Term
    body: Body


class Fork(Node):
    """``a |&| b`` (operator ``and``) or ``a ||| b`` (operator ``or``); flattened, two or more branches."""

    operator: str
    branches: tuple[Body, ...]


Step = Achieve | Test | BeliefChange | ExternalAction | Constraint | If | While | For | Fork


class Body(Node):
    """The formulae of a plan body in order; a parenthesised group is spliced in."""

    steps: tuple[Step, ...] = ()


class Trigger(Node):
    """``+!g``: ``operator`` is ``+``, ``-`` or ``^``; ``kind`` is ``""`` (belief), ``!`` or ``?``."""

    operator: str
    kind: str
    literal: Literal | Variable


class Plan(Node):
    """A plan; ``label`` is a Literal (its annotations hold ``atomic`` and user data), or a Variable in plan
    terms, or None."""

    label: Literal | Variable | None
    trigger: Trigger
    context: Term | None
    body: Body | Variable
    goal_condition: Term | None = None
    subplans: tuple[Plan, ...] = ()


class Rule(Node):
    """``head :- body``."""

    head: Literal
    body: Term


class RegisteredFunction(Node):
    """``{ register_function("name.x", Arity, "rule") }``: an arithmetic function that the program defines.

    The rule (or internal action) ``implementation`` has one more argument, for the result.
    """

    name: str
    arity: int
    implementation: str


@dataclass(frozen=True)
class Program:
    """An agent program with its includes resolved, in source order per kind.

    Attributes:
        walked: plans with their nodes, by identity; programs that include the same library may share them.
    """

    beliefs: tuple[Literal | Rule, ...] = ()
    goals: tuple[Literal, ...] = ()
    plans: tuple[Plan, ...] = ()
    functions: tuple[RegisteredFunction, ...] = ()
    offers: tuple[Offer, ...] = ()
    walked: dict[int, tuple[Plan, ByKind]] = field(
        default_factory=dict, compare=False, repr=False, kw_only=True
    )

    @cached_property
    def found(self) -> ByKind:
        """All nodes of its beliefs, goals (offered ones, too) and plans; the checks share this walk."""
        return ByKind(
            self.beliefs, self.goals, self.offered_goals, others=[found for _, found in self.in_plans]
        )

    @cached_property
    def offered_goals(self) -> tuple[Literal, ...]:
        """The goals that callers outside may post."""
        return tuple([form_of(each) for each in self.offers if each.what == "goal"])

    @cached_property
    def in_plans(self) -> list[tuple[Plan, ByKind]]:
        """The plans, each with its nodes."""
        for plan in self.plans:
            if id(plan) not in self.walked:
                self.walked[id(plan)] = plan, ByKind(plan)
        return [self.walked[id(plan)] for plan in self.plans]


def form_of(offer: Offer) -> Literal:
    """Return what is offered with a variable for each argument, such as ``deliver(Parcel, Room)``."""
    names = [each.name[:1].upper() + each.name[1:] for each in offer.parameters]
    variables = tuple([Variable(name, span=offer.span) for name in names])
    return Literal(offer.name, variables, span=offer.span)


@dataclass
class Section:
    """The clauses of a file or of a directive's block while they are collected, in source order per kind."""

    beliefs: list[Literal | Rule] = field(default_factory=list)
    goals: list[Literal] = field(default_factory=list)
    plans: list[Plan] = field(default_factory=list)
    functions: list[RegisteredFunction] = field(default_factory=list)
    offers: list[Offer] = field(default_factory=list)

    def extend(self, other: Section) -> None:
        """Append the clauses of *other*."""
        for kind in fields(self):
            getattr(self, kind.name).extend(getattr(other, kind.name))

    def program(self) -> Program:
        """Return the finished program."""
        return Program(*[tuple(getattr(self, kind.name)) for kind in fields(self)])


# Declarations of internal actions, as the parser, checker, compiler and mind see them.


@dataclass(frozen=True, slots=True, kw_only=True)
class Declaration:
    """What is known of an internal action without its code.

    Attributes:
        arity: number of arguments, or their minimum and maximum (None: any number).
        suspends: it may suspend the intention, or acts on it; as a condition it is probably a mistake.
        body_only: it acts or waits, so it never holds as a condition; contexts reject those of the language.
        condition: index of the argument that is a condition.
        performative: index of the performative, for actions that send messages; the last argument is the content.
        awaits: its arguments in braces are events that it waits for.
        prints: it only shows its arguments to people or callers.
        brings_in: it adds plans or agents that do not appear in the program.
        changes_plans: it adds or removes plans.
        result_hint: how its author adds an argument for the result; empty for actions that have one or are not in Python.
    """

    arity: int | tuple[int, int | None] = (0, None)
    suspends: bool = False
    body_only: bool = False
    condition: int | None = None
    performative: int | None = None
    awaits: bool = False
    prints: bool = False
    brings_in: bool = False
    changes_plans: bool = False
    result_hint: str = ""

    @property
    def minimum(self) -> int:
        """The minimum number of arguments."""
        return self.arity if isinstance(self.arity, int) else self.arity[0]

    @property
    def maximum(self) -> int | None:
        """The maximum number of arguments; None for any number."""
        return self.arity if isinstance(self.arity, int) else self.arity[1]

    def takes(self, count: int) -> bool:
        """Return whether it accepts that number of arguments."""
        if isinstance(self.arity, int):
            return count == self.arity
        least, most = self.arity
        return least <= count and (most is None or count <= most)


UNDECLARED = Declaration()
"""Declaration of a name that nothing declares."""


# Walk syntax trees: their nodes, variables and shape.


def walk(*roots: object) -> Iterator[Node]:
    """Yield the *roots* and all nodes below them, in source order."""
    stack: list[object] = list(roots[::-1])
    while stack:
        part = stack.pop()
        kind = part.__class__
        if kind in _PLAIN:
            continue
        if isinstance(part, tuple):
            stack += part[::-1]
        elif isinstance(part, Node):
            yield part
            stack += part.parts()[::-1]


_PLAIN = frozenset({str, type(None), bool, int, float})
"""Classes of most parts: the checks of a program walk over each of them some forty times."""


def rebuilt(node: Any, change: Callable[[Node], Any]) -> Any:
    """Return a copy of a tree with *change* applied to each node, to the inner ones first."""
    if isinstance(node, tuple):
        return tuple([rebuilt(part, change) for part in node])
    if not isinstance(node, Node):
        return node
    return change(type(node)(*[rebuilt(part, change) for part in node.parts()], span=node.span))


def is_ground(node: object) -> bool:
    """Return whether there is no variable in a piece of syntax."""
    return next(variables_in(node), None) is None


def children(node: Node) -> Iterator[Node]:
    """Yield the direct children of *node*, in source order."""
    for part in node.parts():
        if isinstance(part, Node):
            yield part
        elif isinstance(part, tuple):
            yield from part


def variables_in(node: object) -> Iterator[Variable]:
    """Yield all occurrences of variables, in order, those of nested plans and bodies included."""
    return nodes_in(Variable, node)


def names_in(*parts: object) -> list[str]:
    """Return the names of the variables, each once, in order of appearance; unnamed ones are left out."""
    names: dict[str, None] = {}
    for part in parts:
        for variable in variables_in(part):
            if not variable.unnamed:
                names[variable.name] = None
    return list(names)


def occurrences(*parts: object) -> dict[str, int]:
    """Count the occurrences of each named variable."""
    counts: dict[str, int] = {}
    for part in parts:
        for variable in variables_in(part):
            if not variable.unnamed:
                counts[variable.name] = counts.get(variable.name, 0) + 1
    return counts


def parts_of(formula: Term) -> Iterator[Term]:
    """Yield the conditions that *formula* joins by ``&``, ``|`` and ``not``, in source order."""
    stack = [formula]
    while stack:
        term = stack.pop()
        if isinstance(term, Connective):
            stack += reversed(term.operands)
        else:
            yield term


N = TypeVar("N", bound=Node)


def nodes_in(kind: type[N], node: object) -> Iterator[N]:
    """Yield all nodes of a kind in a piece of syntax, in order."""
    return (part for part in walk(node) if isinstance(part, kind))


def operands(node: And | Or) -> list[Node]:
    """Return the formulae that a chain of the same operator joins, from left to right."""
    kind = type(node)
    found: list[Node] = []
    stack: list[Node] = [node]
    while stack:
        node_ = stack.pop()
        if isinstance(node_, kind):
            stack += (node_.right, node_.left)
        else:
            found.append(node_)
    return found


def shape(node: object, names: dict[str, int] | None = None) -> object:
    """Return the tree without places and with numbered variables, for comparison.

    Trees that differ only in the names of their variables have equal shapes.
    """
    names = {} if names is None else names
    if isinstance(node, Variable):
        number = names.setdefault(node.name, len(names))
        return (number, shape(node.annotations, names), shape(node.namespace, names), node.negated)
    if isinstance(node, tuple):
        return tuple([shape(part, names) for part in node])
    if isinstance(node, Node):
        return (type(node).__name__, *[shape(part, names) for part in node.parts()])
    return node


class ByKind:
    """All nodes of pieces of syntax by their kind, collected in one walk."""

    def __init__(self, *roots: object, others: Iterable[ByKind] = ()) -> None:
        self._nodes: defaultdict[type, list[Any]] = defaultdict(list)
        for node in walk(*roots):
            self._nodes[type(node)].append(node)
        for each in others:
            for kind, found in each._nodes.items():
                self._nodes[kind] += found

    def of(self, *kinds: type[N]) -> list[N]:
        """Return the nodes of these kinds, in order for each kind."""
        return [node for kind in kinds for node in self._nodes[kind]]
