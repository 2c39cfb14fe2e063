"""The syntax tree of AgentSpeak: plain frozen data, each node with its place in the source.

Terms, logical formulae and body formulae share `Term`, as in the language, where plans and conditions may be
passed as arguments.
"""

from dataclasses import dataclass, field

from jacaros.asl.source import Span


@dataclass(frozen=True, slots=True)
class Node:
    """What all nodes have: a place in the source (None for nodes made at run time)."""

    span: Span | None = field(default=None, kw_only=True, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Number(Node):
    """A number literal; all numbers are doubles."""

    value: float


@dataclass(frozen=True, slots=True)
class String(Node):
    r"""A string literal, with ``\n`` and ``\"`` already converted and no other escape."""

    value: str


@dataclass(frozen=True, slots=True)
class Variable(Node):
    """A variable.  Every occurrence of an unnamed one (``_``, ``_X``) has its own ``name`` (``_7``)."""

    name: str
    annotations: "Annotations | None" = None
    namespace: "str | Variable | None" = None
    negated: bool = False
    unnamed: bool = False


@dataclass(frozen=True, slots=True)
class Annotations(Node):
    """``[a, b | T]``: the elements and the tail."""

    items: "tuple[Term, ...]"
    tail: "Variable | None" = None


@dataclass(frozen=True, slots=True)
class Literal(Node):
    """An atom, structure, or literal: ``ns::~f(a, b)[annots]``.

    ``functor`` keeps the quotes of a quoted atom.  ``namespace`` is None for the default namespace, a name,
    or a variable; namespace directives are already applied by the parser.
    """

    functor: str
    arguments: "tuple[Term, ...]" = ()
    negated: bool = False
    annotations: Annotations | None = None
    namespace: str | Variable | None = None


@dataclass(frozen=True, slots=True)
class ListTerm(Node):
    """``[a, b | T]``; ``items`` may be empty with a tail (``[|T]``)."""

    items: "tuple[Term, ...]"
    tail: "Term | None" = None


@dataclass(frozen=True, slots=True)
class Arithmetic(Node):
    """``+ - * / div mod **`` with two operands, ``-`` (and ``+``) with one."""

    operator: str
    operands: "tuple[Term, ...]"


@dataclass(frozen=True, slots=True)
class FunctionCall(Node):
    """An arithmetic function: ``math.max(X, 3)``, ``.length(L)``, ``.count(p(_))``, ``system.time``."""

    name: str
    arguments: "tuple[Term, ...]"


@dataclass(frozen=True, slots=True)
class Relation(Node):
    """``left op right`` with one of ``< <= > >= == \\== = =..``."""

    operator: str
    left: "Term"
    right: "Term"


@dataclass(frozen=True, slots=True)
class Not(Node):
    """``not F``."""

    operand: "Term"


@dataclass(frozen=True, slots=True)
class And(Node):
    """``A & B``."""

    left: "Term"
    right: "Term"


@dataclass(frozen=True, slots=True)
class Or(Node):
    """``A | B``."""

    left: "Term"
    right: "Term"


@dataclass(frozen=True, slots=True)
class InternalAction(Node):
    """``.name(args)`` or ``pkg.name(args)``; ``name`` includes the leading dot of the standard ones."""

    name: str
    arguments: "tuple[Term, ...]" = ()


@dataclass(frozen=True, slots=True)
class PlanTerm(Node):
    """``{ @l +!g : c <- b }`` as a term."""

    plan: "Plan"


@dataclass(frozen=True, slots=True)
class RuleTerm(Node):
    """``{ h :- b }`` as a term."""

    rule: "Rule"


@dataclass(frozen=True, slots=True)
class TriggerTerm(Node):
    """``{ +!g }``, ``{ -?g(X) }`` as a term (``{ +b }`` is a `BodyTerm`: a belief addition)."""

    trigger: "Trigger"


@dataclass(frozen=True, slots=True)
class BodyTerm(Node):
    """``{ a; !b }`` or ``{ }`` as a term."""

    body: "Body"


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


@dataclass(frozen=True, slots=True)
class Achieve(Node):
    """``!g`` or, with ``separate``, ``!!g``; the goal is a Literal or a Variable."""

    goal: Literal | Variable
    separate: bool = False


@dataclass(frozen=True, slots=True)
class Test(Node):
    """``?q``; the formula is any condition."""

    formula: Term


@dataclass(frozen=True, slots=True)
class BeliefChange(Node):
    """A change of beliefs (or of plans and rules, when the operand is a PlanTerm or RuleTerm).

    ``operator`` is one of ``+ - -+ ++ -- +< +> -++`` as written.
    """

    operator: str
    operand: Term


@dataclass(frozen=True, slots=True)
class ExternalAction(Node):
    """``f(..)``: an action of the environment, with its annotations; or a bare variable as a step."""

    action: Literal | Variable


@dataclass(frozen=True, slots=True)
class Constraint(Node):
    """``X = f(Y)``, ``X < 3``, or an internal action: a formula as a body step."""

    formula: Relation | InternalAction


@dataclass(frozen=True, slots=True)
class If(Node):
    """``if (c) {..} elif (d) {..} else {..}``; an elif is an `If` alone in ``otherwise``."""

    condition: Term
    then: "Body"
    otherwise: "Body | None" = None


@dataclass(frozen=True, slots=True)
class While(Node):
    """``while (c) {..}``."""

    condition: Term
    body: "Body"


@dataclass(frozen=True, slots=True)
class For(Node):
    """``for (c) {..}``."""

    condition: Term
    body: "Body"


@dataclass(frozen=True, slots=True)
class Fork(Node):
    """``a |&| b`` (operator ``and``) or ``a ||| b`` (operator ``or``); flattened, two or more branches."""

    operator: str
    branches: "tuple[Body, ...]"


Step = Achieve | Test | BeliefChange | ExternalAction | Constraint | If | While | For | Fork


@dataclass(frozen=True, slots=True)
class Body(Node):
    """The formulae of a plan body in order; a parenthesised group is spliced in."""

    steps: tuple[Step, ...] = ()


@dataclass(frozen=True, slots=True)
class Trigger(Node):
    """``+!g``: ``operator`` is ``+``, ``-`` or ``^``; ``kind`` is ``""`` (belief), ``!`` or ``?``."""

    operator: str
    kind: str
    literal: Literal | Variable


@dataclass(frozen=True, slots=True)
class Plan(Node):
    """A plan; ``label`` is a Literal (its annotations hold ``atomic`` and user data), or a Variable in plan
    terms, or None."""

    label: Literal | Variable | None
    trigger: Trigger
    context: Term | None
    body: Body | Variable
    goal_condition: Term | None = None
    subplans: "tuple[Plan, ...]" = ()


@dataclass(frozen=True, slots=True)
class Rule(Node):
    """``head :- body``."""

    head: Literal
    body: Term


@dataclass(frozen=True, slots=True)
class RegisteredFunction(Node):
    """``{ register_function("name.x", Arity, "rule") }``: an arithmetic function of the program's own.

    The rule (or internal action) ``implementation`` has one argument more, for the result.
    """

    name: str
    arity: int
    implementation: str


@dataclass(frozen=True, slots=True)
class Program:
    """One agent program with its includes already in place, in source order per kind."""

    beliefs: tuple[Literal | Rule, ...] = ()
    goals: tuple[Literal, ...] = ()
    plans: tuple[Plan, ...] = ()
    functions: tuple[RegisteredFunction, ...] = ()
