"""The syntax tree of AgentSpeak: plain frozen data, each node with its place in the source.

Terms, logical formulae and body formulae share `Term`, as in the language, where plans and conditions may be
passed as arguments.
"""

from dataclasses import dataclass
from typing import Any, ClassVar, Final, TypeVar

from jacaros.asl.source import Span


class Node:
    """What all nodes have: a place in the source (None for nodes made at run time).

    Two nodes are equal when they are of one class and their parts are; the place does not count.  The classes are
    written out: as dataclasses the thirty of them took a fifth of the time in which a program starts.
    """

    __slots__ = ("span",)
    __match_args__: ClassVar[tuple[str, ...]] = ()
    """The names of the parts, in the order of the text."""

    span: Span | None

    def parts(self) -> tuple[Any, ...]:
        """The values of the parts, in the order of the text."""
        return tuple([getattr(self, name) for name in self.__match_args__])

    def __eq__(self, other: object) -> bool:
        if other.__class__ is not self.__class__:
            return NotImplemented
        return self is other or self.parts() == other.parts()

    def __hash__(self) -> int:
        return hash((self.__class__, self.parts()))

    def __repr__(self) -> str:
        shown = ", ".join(f"{name}={getattr(self, name)!r}" for name in self.__match_args__)
        return f"{type(self).__name__}({shown})"


Some = TypeVar("Some", bound=Node)


def replace(node: Some, **parts: Any) -> Some:
    """The same node with other *parts*, or at another place (``span``)."""
    kept = dict(zip(node.__match_args__, node.parts(), strict=True))
    return type(node)(**{**kept, "span": node.span, **parts})


class Number(Node):
    """A number literal; all numbers are doubles."""

    __slots__ = __match_args__ = ("value",)

    def __init__(self, value: float, *, span: Span | None = None) -> None:
        self.value: Final = value
        self.span = span


class String(Node):
    r"""A string literal, with ``\n`` and ``\"`` already converted and no other escape."""

    __slots__ = __match_args__ = ("value",)

    def __init__(self, value: str, *, span: Span | None = None) -> None:
        self.value: Final = value
        self.span = span


class Variable(Node):
    """A variable.  Every occurrence of an unnamed one (``_``, ``_X``) has its own ``name`` (``_7``)."""

    __slots__ = __match_args__ = ("name", "annotations", "namespace", "negated", "unnamed")

    def __init__(
        self,
        name: str,
        annotations: "Annotations | None" = None,
        namespace: "str | Variable | None" = None,
        negated: bool = False,
        unnamed: bool = False,
        *,
        span: Span | None = None,
    ) -> None:
        self.name: Final = name
        self.annotations: Final = annotations
        self.namespace: Final = namespace
        self.negated: Final = negated
        self.unnamed: Final = unnamed
        self.span = span


class Annotations(Node):
    """``[a, b | T]``: the elements and the tail."""

    __slots__ = __match_args__ = ("items", "tail")

    def __init__(
        self, items: "tuple[Term, ...]", tail: "Variable | None" = None, *, span: Span | None = None
    ) -> None:
        self.items: Final = items
        self.tail: Final = tail
        self.span = span


class Literal(Node):
    """An atom, structure, or literal: ``ns::~f(a, b)[annots]``.

    ``functor`` keeps the quotes of a quoted atom.  ``namespace`` is None for the default namespace, a name,
    or a variable; namespace directives are already applied by the parser.
    """

    __slots__ = __match_args__ = ("functor", "arguments", "negated", "annotations", "namespace")

    def __init__(
        self,
        functor: str,
        arguments: "tuple[Term, ...]" = (),
        negated: bool = False,
        annotations: Annotations | None = None,
        namespace: str | Variable | None = None,
        *,
        span: Span | None = None,
    ) -> None:
        self.functor: Final = functor
        self.arguments: Final = arguments
        self.negated: Final = negated
        self.annotations: Final = annotations
        self.namespace: Final = namespace
        self.span = span


class ListTerm(Node):
    """``[a, b | T]``; ``items`` may be empty with a tail (``[|T]``)."""

    __slots__ = __match_args__ = ("items", "tail")

    def __init__(
        self, items: "tuple[Term, ...]", tail: "Term | None" = None, *, span: Span | None = None
    ) -> None:
        self.items: Final = items
        self.tail: Final = tail
        self.span = span


class Arithmetic(Node):
    """An arithmetic operation of two numbers, such as ``X mod 2``, or of one, ``-X`` or ``+X``."""

    __slots__ = __match_args__ = ("operator", "operands")

    def __init__(self, operator: str, operands: "tuple[Term, ...]", *, span: Span | None = None) -> None:
        self.operator: Final = operator
        self.operands: Final = operands
        self.span = span


class FunctionCall(Node):
    """An arithmetic function: ``math.max(X, 3)``, ``.length(L)``, ``.count(p(_))``, ``system.time``."""

    __slots__ = __match_args__ = ("name", "arguments")

    def __init__(self, name: str, arguments: "tuple[Term, ...]", *, span: Span | None = None) -> None:
        self.name: Final = name
        self.arguments: Final = arguments
        self.span = span


class _Binary(Node):
    """Two operands."""

    __slots__ = __match_args__ = ("left", "right")

    def __init__(self, left: "Term", right: "Term", *, span: Span | None = None) -> None:
        self.left: Final = left
        self.right: Final = right
        self.span = span

    @property
    def operands(self) -> "tuple[Term, ...]":
        """Both of them, in the order of the text."""
        return self.left, self.right


class Relation(_Binary):
    r"""``left op right``, such as ``X < 3`` or ``X \== Y``."""

    __slots__ = ("operator",)
    __match_args__ = ("operator", "left", "right")

    def __init__(self, operator: str, left: "Term", right: "Term", *, span: Span | None = None) -> None:
        super().__init__(left, right, span=span)
        self.operator: Final = operator


class And(_Binary):
    """``A & B``."""

    __slots__ = ()
    operator: Final = "&"


class Or(_Binary):
    """``A | B``."""

    __slots__ = ()
    operator: Final = "|"


class Not(Node):
    """``not F``."""

    __slots__ = __match_args__ = ("operand",)
    operator: Final = "not"

    def __init__(self, operand: "Term", *, span: Span | None = None) -> None:
        self.operand: Final = operand
        self.span = span

    @property
    def operands(self) -> "tuple[Term, ...]":
        """The one operand."""
        return (self.operand,)


Connective = And | Or | Not
CONNECTIVES: Final[dict[str, Any]] = {kind.operator: kind for kind in (And, Or, Not)}
"""The classes of the connectives by their operators."""


class InternalAction(Node):
    """``.name(args)`` or ``pkg.name(args)``; ``name`` includes the leading dot of the standard ones."""

    __slots__ = __match_args__ = ("name", "arguments")

    def __init__(self, name: str, arguments: "tuple[Term, ...]" = (), *, span: Span | None = None) -> None:
        self.name: Final = name
        self.arguments: Final = arguments
        self.span = span


class PlanTerm(Node):
    """``{ @l +!g : c <- b }`` as a term."""

    __slots__ = __match_args__ = ("plan",)

    def __init__(self, plan: "Plan", *, span: Span | None = None) -> None:
        self.plan: Final = plan
        self.span = span


class RuleTerm(Node):
    """``{ h :- b }`` as a term."""

    __slots__ = __match_args__ = ("rule",)

    def __init__(self, rule: "Rule", *, span: Span | None = None) -> None:
        self.rule: Final = rule
        self.span = span


class TriggerTerm(Node):
    """``{ +!g }``, ``{ -?g(X) }`` as a term (``{ +b }`` is a `BodyTerm`: a belief addition)."""

    __slots__ = __match_args__ = ("trigger",)

    def __init__(self, trigger: "Trigger", *, span: Span | None = None) -> None:
        self.trigger: Final = trigger
        self.span = span


class BodyTerm(Node):
    """``{ a; !b }`` or ``{ }`` as a term."""

    __slots__ = __match_args__ = ("body",)

    def __init__(self, body: "Body", *, span: Span | None = None) -> None:
        self.body: Final = body
        self.span = span


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
"""Any term.  ``true`` and ``false`` are `Literal`s of those names, also as formulae."""


class Achieve(Node):
    """``!g`` or, with ``separate``, ``!!g``; the goal is a Literal or a Variable."""

    __slots__ = __match_args__ = ("goal", "separate")

    def __init__(self, goal: Literal | Variable, separate: bool = False, *, span: Span | None = None) -> None:
        self.goal: Final = goal
        self.separate: Final = separate
        self.span = span


class Test(Node):
    """``?q``; the formula is any condition."""

    __slots__ = __match_args__ = ("formula",)

    def __init__(self, formula: Term, *, span: Span | None = None) -> None:
        self.formula: Final = formula
        self.span = span


class BeliefChange(Node):
    """A change of beliefs (or of plans and rules, when the operand is a PlanTerm or RuleTerm).

    ``operator`` is one of ``+ - -+ ++ -- +< +> -++`` as written.
    """

    __slots__ = __match_args__ = ("operator", "operand")

    def __init__(self, operator: str, operand: Term, *, span: Span | None = None) -> None:
        self.operator: Final = operator
        self.operand: Final = operand
        self.span = span


class ExternalAction(Node):
    """``f(..)``: an action of the environment, with its annotations; or a bare variable as a step."""

    __slots__ = __match_args__ = ("action",)

    def __init__(self, action: Literal | Variable, *, span: Span | None = None) -> None:
        self.action: Final = action
        self.span = span


class Constraint(Node):
    """``X = f(Y)``, ``X < 3``, or an internal action: a formula as a body step."""

    __slots__ = __match_args__ = ("formula",)

    def __init__(self, formula: Relation | InternalAction, *, span: Span | None = None) -> None:
        self.formula: Final = formula
        self.span = span


class If(Node):
    """``if (c) {..} elif (d) {..} else {..}``; an elif is an `If` alone in ``otherwise``."""

    __slots__ = __match_args__ = ("condition", "then", "otherwise")

    def __init__(
        self, condition: Term, then: "Body", otherwise: "Body | None" = None, *, span: Span | None = None
    ) -> None:
        self.condition: Final = condition
        self.then: Final = then
        self.otherwise: Final = otherwise
        self.span = span


class While(Node):
    """``while (c) {..}``."""

    __slots__ = __match_args__ = ("condition", "body")

    def __init__(self, condition: Term, body: "Body", *, span: Span | None = None) -> None:
        self.condition: Final = condition
        self.body: Final = body
        self.span = span


class For(Node):
    """``for (c) {..}``."""

    __slots__ = __match_args__ = ("condition", "body")

    def __init__(self, condition: Term, body: "Body", *, span: Span | None = None) -> None:
        self.condition: Final = condition
        self.body: Final = body
        self.span = span


class Fork(Node):
    """``a |&| b`` (operator ``and``) or ``a ||| b`` (operator ``or``); flattened, two or more branches."""

    __slots__ = __match_args__ = ("operator", "branches")

    def __init__(self, operator: str, branches: "tuple[Body, ...]", *, span: Span | None = None) -> None:
        self.operator: Final = operator
        self.branches: Final = branches
        self.span = span


Step = Achieve | Test | BeliefChange | ExternalAction | Constraint | If | While | For | Fork


class Body(Node):
    """The formulae of a plan body in order; a parenthesised group is spliced in."""

    __slots__ = __match_args__ = ("steps",)

    def __init__(self, steps: tuple[Step, ...] = (), *, span: Span | None = None) -> None:
        self.steps: Final = steps
        self.span = span


class Trigger(Node):
    """``+!g``: ``operator`` is ``+``, ``-`` or ``^``; ``kind`` is ``""`` (belief), ``!`` or ``?``."""

    __slots__ = __match_args__ = ("operator", "kind", "literal")

    def __init__(
        self, operator: str, kind: str, literal: Literal | Variable, *, span: Span | None = None
    ) -> None:
        self.operator: Final = operator
        self.kind: Final = kind
        self.literal: Final = literal
        self.span = span


class Plan(Node):
    """A plan; ``label`` is a Literal (its annotations hold ``atomic`` and user data), or a Variable in plan
    terms, or None."""

    __slots__ = __match_args__ = ("label", "trigger", "context", "body", "goal_condition", "subplans")

    def __init__(
        self,
        label: Literal | Variable | None,
        trigger: Trigger,
        context: Term | None,
        body: Body | Variable,
        goal_condition: Term | None = None,
        subplans: "tuple[Plan, ...]" = (),
        *,
        span: Span | None = None,
    ) -> None:
        self.label: Final = label
        self.trigger: Final = trigger
        self.context: Final = context
        self.body: Final = body
        self.goal_condition: Final = goal_condition
        self.subplans: Final = subplans
        self.span = span


class Rule(Node):
    """``head :- body``."""

    __slots__ = __match_args__ = ("head", "body")

    def __init__(self, head: Literal, body: Term, *, span: Span | None = None) -> None:
        self.head: Final = head
        self.body: Final = body
        self.span = span


class RegisteredFunction(Node):
    """``{ register_function("name.x", Arity, "rule") }``: an arithmetic function of the program's own.

    The rule (or internal action) ``implementation`` has one argument more, for the result.
    """

    __slots__ = __match_args__ = ("name", "arity", "implementation")

    def __init__(self, name: str, arity: int, implementation: str, *, span: Span | None = None) -> None:
        self.name: Final = name
        self.arity: Final = arity
        self.implementation: Final = implementation
        self.span = span


@dataclass(frozen=True, slots=True)
class Program:
    """One agent program with its includes already in place, in source order per kind."""

    beliefs: tuple[Literal | Rule, ...] = ()
    goals: tuple[Literal, ...] = ()
    plans: tuple[Plan, ...] = ()
    functions: tuple[RegisteredFunction, ...] = ()
