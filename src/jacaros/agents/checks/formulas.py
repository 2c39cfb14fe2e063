"""Find the conditions in a program, and those that never hold.

>>> from jacaros.agents.language.loader import parse_formula
>>> contradiction(parse_formula("X < 3 & X > 5"))
'X cannot be both above 5 and below 3'
"""

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, Final, cast

from jacaros.agents.language import nodes
from jacaros.agents.language.cursor import MOST_ASKED
from jacaros.agents.language.diagnostics import Diagnostic, problem
from jacaros.agents.language.lowering import format_term
from jacaros.agents.language.nodes import children, names_in, nodes_in, operands, variables_in, walk
from jacaros.agents.terms.operators import BINARY
from jacaros.runtime.files.texts import did_you_mean, suggestion

Clause = nodes.Plan | nodes.Rule
Key = tuple[str, int]
"""Name and number of arguments."""


def clauses(program: nodes.Program) -> Iterator[Clause]:
    """Yield the plans, then the rules."""
    yield from program.plans
    for belief in program.beliefs:
        if isinstance(belief, nodes.Rule):
            yield belief


CONDITIONED: Final[tuple[type[Any], ...]] = (
    nodes.Plan,
    nodes.Rule,
    nodes.If,
    nodes.While,
    nodes.For,
    nodes.Test,
)
"""The kinds of nodes that have conditions, besides labels and goals with ``while`` and ``achieves``."""


def conditions(node: nodes.Node) -> tuple[nodes.Term, ...]:
    """Return the conditions of *node* itself: contexts, tests, conditions of statements, rules, annotations."""
    match node:
        case nodes.Literal():  # first: most nodes are literals
            return node.arguments[:1] if node.functor in ("while", "achieves") else ()
        case nodes.Plan():
            return tuple([each for each in (node.context, node.goal_condition) if each is not None])
        case nodes.If() | nodes.While() | nodes.For():
            return (node.condition,)
        case nodes.Test():
            return (node.formula,)
        case nodes.Rule():
            return (node.body,)
    return ()


def indicator_of(node: nodes.Node) -> Key:
    """Return name and number of arguments of a literal; no name for other nodes."""
    return (node.functor, len(node.arguments)) if isinstance(node, nodes.Literal) else ("", 0)


def labelled(plan: nodes.Plan) -> list[nodes.Literal]:
    """Return the annotations of a plan's label that are literals."""
    return annotations_of(plan.label) if isinstance(plan.label, nodes.Literal) else []


def annotations_of(term: nodes.Node) -> list[nodes.Literal]:
    """Return the annotations of a literal or variable that are literals."""
    annotations = term.annotations if isinstance(term, nodes.Literal | nodes.Variable) else None
    return (
        [] if annotations is None else [item for item in annotations.items if isinstance(item, nodes.Literal)]
    )


def in_order(root: nodes.Node) -> Iterator[tuple[nodes.Node, bool]]:
    """Yield all nodes below *root* in source order, each with whether it is used as a condition."""
    stack: list[tuple[nodes.Node, bool]] = [(root, False)]
    while stack:
        node, asked = stack.pop()
        yield node, asked
        below = list(children(node))
        roots = conditions(node)
        all_asked = isinstance(node, nodes.Constraint) or (asked and isinstance(node, nodes.Connective))
        stack += [(each, all_asked or any(each is one for one in roots)) for each in reversed(below)]


def is_true(formula: nodes.Term | None) -> bool:
    """Return whether *formula* always holds: it is missing or ``true``."""
    return formula is None or (
        isinstance(formula, nodes.Literal) and formula.functor == "true" and not formula.arguments
    )


def contradiction(formula: nodes.Term, constants: bool = True) -> str | None:
    """Explain why *formula* never holds, or return None if that is not evident, or only *constants* are compared."""
    if isinstance(formula, nodes.Or):
        reasons = [contradiction(cast("nodes.Term", each), constants) for each in operands(formula)]
        return None if None in reasons else reasons[0]
    parts = _conjuncts(formula)
    return (_constant(parts) if constants else None) or _both_ways(parts) or _no_value(parts)


def _conjuncts(formula: nodes.Term) -> list[nodes.Term]:
    """Return the parts of a conjunction; ``not X < 3`` is ``X >= 3``."""
    parts = operands(formula) if isinstance(formula, nodes.And) else [formula]
    return [_without_not(cast("nodes.Term", part)) for part in parts]


_OPPOSITE: Final = {"==": r"\==", r"\==": "==", "<": ">=", ">=": "<", ">": "<=", "<=": ">"}
_MIRRORED: Final = {"<": ">", ">": "<", "<=": ">=", ">=": "<="}


def _without_not(part: nodes.Term) -> nodes.Term:
    inner = part.operand if isinstance(part, nodes.Not) else None
    if isinstance(inner, nodes.Relation) and inner.operator in _OPPOSITE:
        return nodes.replace(inner, operator=_OPPOSITE[inner.operator])
    return part


def _constant(parts: Sequence[nodes.Term]) -> str | None:
    """``false``, ``not true``, ``2 > 3``, ``a == b`` or ``X < X``."""
    for part in parts:
        if isinstance(part, nodes.Literal) and part.functor == "false" and not part.arguments:
            return "its condition is false"
        if isinstance(part, nodes.Not) and is_true(part.operand):
            return "`not true` never holds"
        if isinstance(part, nodes.Relation) and _never_holds(part):
            return f"`{format_term(part)}` never holds"
    return None


def _never_holds(relation: nodes.Relation) -> bool:
    left, right, operator = relation.left, relation.right, relation.operator
    if isinstance(left, nodes.Number) and isinstance(right, nodes.Number):
        holds = BINARY[operator].numbers
        return holds is not None and not holds(left.value, right.value)
    if isinstance(left, nodes.Variable) and left == right:
        return operator in ("<", ">", r"\==")
    if _is_constant(left) and _is_constant(right):
        return operator == r"\==" if left == right else operator in ("=", "==")
    return False


def _both_ways(parts: Sequence[nodes.Term]) -> str | None:
    r"""``p(X) & not p(X)``, ``X == Y & X \== Y``."""
    plain = [part for part in parts if isinstance(part, nodes.Literal | nodes.Relation) and _is_fixed(part)]
    for part in parts:
        if isinstance(part, nodes.Not) and part.operand in plain:
            text = format_term(part.operand)
            return f"`{text}` and `not {text}` cannot both hold"
        if isinstance(part, nodes.Relation) and part.operator in _OPPOSITE:
            other = nodes.replace(part, operator=_OPPOSITE[part.operator])
            if other in plain:
                return f"`{format_term(other)}` and `{format_term(part)}` cannot both hold"
    return None


def _is_fixed(term: nodes.Term) -> bool:
    """Return whether two occurrences of *term* mean the same."""
    return not any(variable.unnamed for variable in variables_in(term))


_SAYING: Final = {"<": "below ", "<=": "at most ", ">": "above ", ">=": "at least ", r"\==": "not "}


def _no_value(parts: Sequence[nodes.Term]) -> str | None:
    """``X == 1 & X == 2``, ``X < 3 & X > 5``, ``X == 2 & X > 5``."""
    limits: dict[str, list[tuple[str, nodes.Term]]] = {}
    for name, operator, value in filter(None, map(_variable_and_constant, parts)):
        for other, limit in limits.setdefault(name, []):
            if _exclude(other, limit, operator, value):
                pair = sorted(((operator, value), (other, limit)), key=lambda each: "=><".find(each[0][0]))
                said = [f"{_SAYING.get(sign, '')}{format_term(each)}" for sign, each in pair]
                return f"{name} cannot be both {said[0]} and {said[1]}"
        limits[name].append((operator, value))
    return None


def _exclude(one: str, limit: nodes.Term, other: str, value: nodes.Term) -> bool:
    """Return whether no value is in both relations to constants."""
    if one == "==":
        return not _is_in(limit, other, value)
    if other == "==":
        return not _is_in(value, one, limit)
    if not isinstance(limit, nodes.Number) or not isinstance(value, nodes.Number) or r"\==" in (one, other):
        return False
    if one[0] == other[0]:
        return False
    low, high = (limit.value, value.value) if one[0] == ">" else (value.value, limit.value)
    return low > high or (low == high and not one.endswith("=") & other.endswith("="))


def _is_in(value: nodes.Term, operator: str, limit: nodes.Term) -> bool:
    """Return whether a constant is in a relation to another one, or may be: atoms and numbers are not compared."""
    if operator in ("==", r"\=="):
        return (value == limit) is (operator == "==")
    holds = BINARY[operator].numbers
    if holds is None or not isinstance(value, nodes.Number) or not isinstance(limit, nodes.Number):
        return True
    return bool(holds(value.value, limit.value))


def _variable_and_constant(part: nodes.Term) -> tuple[str, str, nodes.Term] | None:
    """Return the variable, the operator and the constant of ``X op constant``."""
    if not isinstance(part, nodes.Relation):
        return None
    left, right, operator = part.left, part.right, part.operator
    if isinstance(right, nodes.Variable):
        left, right, operator = right, left, _MIRRORED.get(operator, operator)
    if not isinstance(left, nodes.Variable) or left.annotations is not None or left.unnamed:
        return None
    operator = "==" if operator == "=" else operator
    return (left.name, operator, right) if _is_constant(right) and operator in _OPPOSITE else None


def _is_constant(term: nodes.Term) -> bool:
    """Return whether a term is a number, a string or an atom."""
    atom = isinstance(term, nodes.Literal) and not term.arguments and term.annotations is None
    return atom or isinstance(term, nodes.Number | nodes.String)


def implies(formula: nodes.Term, other: nodes.Term) -> bool:
    """Return whether *other* evidently holds whenever *formula* does: it has the same parts, or less strict ones."""
    if isinstance(formula, nodes.Or):
        return all(implies(cast("nodes.Term", each), other) for each in operands(formula))
    parts = _conjuncts(formula)
    return all(_follows(part, parts) for part in _conjuncts(other))


def _follows(part: nodes.Term, parts: Sequence[nodes.Term]) -> bool:
    if any(_is_like(part, each, True) for each in parts):
        return True
    if isinstance(part, nodes.Or):
        return any(_follows(cast("nodes.Term", each), parts) for each in operands(part))
    wanted = _variable_and_constant(part)
    return wanted is not None and any(
        known[0] == wanted[0] and _exclude(*known[1:], _OPPOSITE[wanted[1]], wanted[2])
        for known in filter(None, map(_variable_and_constant, parts))
    )


def _is_like(part: object, other: object, any_term: bool) -> bool:
    """Return whether two parts are equal but for unnamed variables, which outside of ``not`` are like any term."""
    if isinstance(part, nodes.Variable) and part.unnamed:
        return any_term or (isinstance(other, nodes.Variable) and other.unnamed)
    if isinstance(part, tuple) and isinstance(other, tuple):
        return len(part) == len(other) and all(
            _is_like(one, two, any_term) for one, two in zip(part, other, strict=True)
        )
    if isinstance(part, nodes.Node) and isinstance(other, nodes.Node) and type(part) is type(other):
        return _is_like(part.parts(), other.parts(), any_term and not isinstance(part, nodes.Not))
    return part == other


# Check for variables that occur once, and comparisons with variables that have no value.


_WORD: Final = re.compile(r"\b[A-Z]\w*")
_APART: Final = re.compile(r"[0-9A-Z]")
"""What tells names of their own apart, as in ``X1`` and ``X2``, ``GoalX`` and ``GoalY``."""
_CONSTANTS: Final = {
    "True": "write `true` in lower case",
    "TRUE": "write `true` in lower case",
    "False": "write `false` in lower case",
    "FALSE": "write `false` in lower case",
    "None": "use an atom such as `none`; the language has no null value",
    "Null": "use an atom such as `null`; the language has no null value",
    "NULL": "use an atom such as `null`; the language has no null value",
    "Nil": "write the empty list as `[]`",
}
"""Variables that are constants in other languages."""


def singletons(clause: Clause, found: nodes.ByKind) -> Iterator[Diagnostic]:
    """Warn of variables that occur once in *clause*, whose nodes are *found*.

    One in a trigger (or in the head of a rule) may only document the argument: it causes no warning, but may be the name
    that a misspelt variable was meant to have.
    """
    named = [each for each in found.of(nodes.Variable) if not each.unnamed and each.name[0] != "_"]
    occurrences = Counter([each.name for each in named])
    once = [name for name, count in occurrences.items() if count == 1]
    if not once:
        return
    # .puts and .term2string find variables in their texts.
    in_texts = {word for each in found.of(nodes.String) for word in _WORD.findall(each.value)}
    once = [name for name in once if name not in in_texts]
    first = {each.name: each for each in reversed(named)}
    atoms = {each.functor: each for each in reversed(found.of(nodes.Literal)) if not each.arguments}
    what = "plan" if isinstance(clause, nodes.Plan) else "rule"
    in_head = _in_head(clause)
    for number, name in enumerate(once):
        if name in _CONSTANTS:
            yield problem(
                "capital-constant",
                f"`{name}` is a variable here, not a value",
                first[name].span,
                _CONSTANTS[name],
            )
        elif name not in in_head:
            yield problem(
                "singleton-variable",
                f"variable `{name}` occurs only once in this {what}",
                first[name].span,
                _meant_variable(name, occurrences) if number < MOST_ASKED else None,
            )
        elif (atom := atoms.get(name[0].lower() + name[1:])) is not None and atom.functor not in _heads(
            clause
        ):
            message = (
                f"`{atom.functor}` is an atom here, and the variable `{name}` of this {what} is not used"
            )
            yield problem("singleton-variable", message, atom.span, did_you_mean([name]))


def _heads(clause: Clause) -> Iterator[str]:
    """Yield the names in the head of a clause."""
    head = clause.trigger if isinstance(clause, nodes.Plan) else clause.head
    yield from (node.functor for node in walk(head) if isinstance(node, nodes.Literal))


def singletons_of_facts(facts: Iterable[nodes.Literal], what: str) -> Iterator[Diagnostic]:
    """Warn of variables that occur once in an initial belief or goal: most often a name is meant.

    Args:
        facts: all of one kind.
        what: the kind, for the message.
    """
    for fact in facts:
        named = [node for node in variables_in(fact) if not node.name.startswith("_")]
        counted = Counter(node.name for node in named)
        for node in named:
            if counted[node.name] == 1 and not node.unnamed:
                name = node.name
                lower = name[0].lower() + name[1:]
                yield problem(
                    "singleton-variable",
                    f"`{name}` is a variable (capital {name[0]}), so this {what} matches any value",
                    node.span,
                    f"{did_you_mean([lower])} If any value is meant, write `_{name}`",
                )


def _in_head(clause: Clause) -> list[str]:
    return (
        names_in(*nodes_in(nodes.Trigger, clause))
        if isinstance(clause, nodes.Plan)
        else names_in(clause.head)
    )


def _meant_variable(name: str, occurrences: Counter[str]) -> str:
    stem = _APART.sub("", name)
    meant = suggestion(name, (other for other in occurrences if _APART.sub("", other) != stem))
    return f"{meant} Otherwise write `_{name}`" if meant else f"if this is intended, write `_{name}`"


def vain_comparisons(clause: Clause) -> Iterator[Diagnostic]:
    """Warn of comparisons that never hold: ``X == 3`` with an unbound X, ``X = X + 1``."""
    met: set[str] = set()
    for node, asked in in_order(clause):
        if isinstance(node, nodes.Variable):
            met.add(node.name)
        elif asked and isinstance(node, nodes.Relation) and isinstance(node.left, nodes.Variable):
            yield from _vain(node, node.left, met)


def ordered_atoms(relations: Iterable[nodes.Relation]) -> Iterator[Diagnostic]:
    """Warn of comparisons that ignore the order of numbers: ``x > 3``."""
    ordering = [each for each in relations if BINARY[each.operator].orders]
    for atom, other in (sides for each in ordering for sides in (each.operands, each.operands[::-1])):
        if (
            isinstance(atom, nodes.Literal)
            and not atom.arguments
            and isinstance(other, nodes.Number | nodes.Arithmetic)
        ):
            yield problem(
                "ordered-atom",
                f"`{atom.functor}` is an atom, and an atom is greater than any number",
                atom.span,
                f"begin a variable with a capital letter: `{atom.functor[:1].upper()}{atom.functor[1:]}`",
            )


def _vain(relation: nodes.Relation, variable: nodes.Variable, met: set[str]) -> Iterator[Diagnostic]:
    name, right = variable.name, relation.right
    if variable.unnamed:
        return
    if relation.operator == "==" and name not in met:
        yield problem(
            "comparison-without-value",
            f"`{name}` has no value here, so this comparison never holds",
            relation.span,
            f"to give {name} a value, write `{name} = ...`",
        )
    elif relation.operator == "=" and isinstance(right, nodes.Arithmetic) and name in names_in(right):
        yield problem(
            "changed-variable",
            f"`{name}` cannot be equal to a sum that contains it: variables keep their value",
            relation.span,
            f"use another variable, as in `New{name} = {name} + 1`",
        )
