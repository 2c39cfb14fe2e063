"""Terms as AgentSpeak text, printed as Jason prints them."""

import math
from typing import cast

from jacaros.terms.collections import MapValue, QueueValue, SetValue
from jacaros.terms.plans import BODY_SEQUENCE, body_steps, plan_text_parts, step_parts, trigger_parts
from jacaros.terms.unifier import resolve
from jacaros.terms.values import (
    ARITHMETIC,
    CONS,
    LOGIC,
    NEGATED,
    NIL,
    PLAN,
    RELATION,
    Annotated,
    Functor,
    Reference,
    String,
    Term,
    Var,
    deref,
)

_MAX_DEPTH = 300


def number_text(value: float) -> str:
    """A number: integral values without a fraction, others in the shortest form of Java's doubles."""
    if -(2.0**63) <= value <= 2.0**63 and value == math.trunc(value):
        return str(min(int(value), 2**63 - 1))
    return double_text(value)


def double_text(value: float) -> str:
    """A number as Java's ``Double.toString`` writes it: always with a fraction or an exponent."""
    if value != value:
        return "NaN"
    if math.isinf(value):
        return "Infinity" if value > 0 else "-Infinity"
    magnitude = abs(value)
    if 1e-3 <= magnitude < 1e7 or magnitude == 0.0:
        return repr(value)
    mantissa, _, exponent = f"{value!r}e".partition("e")
    if not exponent.rstrip("e"):
        digits, power = _scientific(value)
        return f"{digits}E{power}"
    if "." not in mantissa:
        mantissa += ".0"
    return f"{mantissa}E{int(exponent.rstrip('e'))}"


def _scientific(value: float) -> tuple[str, int]:
    """Digits with one place before the point, and the power of ten, of a number that repr writes plainly."""
    whole, _, fraction = repr(abs(value)).partition(".")
    if whole != "0":
        digits, power = (whole + fraction).rstrip("0"), len(whole) - 1
    else:
        digits = fraction.lstrip("0")
        power = len(digits) - len(fraction) - 1
    return f"{'-' if value < 0 else ''}{digits[0]}.{digits[1:] or '0'}", power


def quoted(text: str) -> str:
    """A string in double quotes."""
    return '"' + text.replace("\n", "\\n").replace('"', '\\"') + '"'


def text(term: Term) -> str:
    """The term with all bindings applied, strings in quotes."""
    return _write(resolve(term), 0)


def display(term: Term) -> str:
    """The term as ``.print`` shows it: a string bare, an unbound variable marked."""
    term = resolve(term)
    if term.__class__ is String:
        return str(term)
    if term.__class__ is Var:
        return f"{term.name}<no-value>"
    return _write(term, 0)


def _write(term: Term, depth: int) -> str:
    if depth > _MAX_DEPTH:
        return "..."
    kind = term.__class__
    if kind is float:
        return number_text(term)
    if kind is String:
        return quoted(term)
    if kind is Functor:
        return _name(term)
    if kind is Var:
        bound = deref(term)
        return str(bound.name) if bound.__class__ is Var else _write(bound, depth + 1)
    if kind is tuple:
        return _write_structure(term, depth)
    if kind is Annotated:
        return _write_annotated(term, depth)
    return _write_object(term, depth)


def _name(symbol: Functor) -> str:
    prefix = f"{symbol.namespace}::" if symbol.namespace else ""
    return f"{prefix}~{symbol.name}" if symbol.negated else prefix + symbol.name


def _write_annotated(term: Annotated, depth: int) -> str:
    inner = ",".join(_write(a, depth + 1) for a in term.annotations)
    if term.tail is not None:
        inner += "|" + _write(term.tail, depth + 1)
    return f"{_write(term.term, depth + 1)}[{inner}]"


def _write_structure(term: tuple[Term, ...], depth: int) -> str:
    symbol = term[0]
    if symbol is CONS:
        return _write_list(term, depth)
    if symbol.kind in (ARITHMETIC, RELATION, LOGIC):
        return _write_operator(term, depth)
    if symbol is NEGATED:
        return "~" + _write(term[1], depth + 1)
    if symbol.kind == PLAN:
        return _write_plan_piece(term, depth)
    arguments = ",".join([_write(a, depth + 1) for a in term[1:]])
    return f"{_name(symbol)}({arguments})"


def _write_list(term: Term, depth: int) -> str:
    parts = []
    while term.__class__ is tuple and term[0] is CONS:
        parts.append(_write(term[1], depth + 1))
        term = deref(term[2])
    return "[" + ",".join(parts) + ("" if term is NIL else "|" + _write(term, depth + 1)) + "]"


def _write_operator(term: tuple[Term, ...], depth: int) -> str:
    symbol = term[0]
    operands = [_write(a, depth + 1) for a in term[1:]]
    if symbol.arity == 1:
        return f"not ({operands[0]})" if symbol.name == "not" else f"({symbol.name}{operands[0]})"
    if symbol.kind == ARITHMETIC and symbol.name not in ("div", "mod"):
        return f"({operands[0]}{symbol.name}{operands[1]})"
    return f"({operands[0]} {symbol.name} {operands[1]})"


def _write_plan_piece(term: tuple[Term, ...], depth: int) -> str:
    name = cast("Functor", term[0]).name
    if name == "plan":
        return "{ " + _write_plan(term, depth) + " }"
    if name == "trigger":
        operator, literal = trigger_parts(term)
        return "{ " + operator + _write(literal, depth + 1) + " }"
    if name == "rule":
        return "{ " + _write(term[1], depth + 1) + " :- " + _write(term[2], depth + 1) + " }"
    if term[0] is BODY_SEQUENCE:
        return "; ".join(_write_step(step, depth + 1) for step in body_steps(term))
    return _write_step(term, depth)


def _write_plan(term: tuple[Term, ...], depth: int) -> str:
    label, operator, literal, context, body = plan_text_parts(term)
    text = ""
    bare_label = deref(label)
    if bare_label.__class__ is not Functor or bare_label.name != "nolabel":
        text = "@" + _write(label, depth + 1) + " "
    text += operator + _write(literal, depth + 1)
    if not (context.__class__ is Functor and context.name == "true"):
        text += " : " + _write(context, depth + 1)
    body_text = _write(body, depth + 1)
    return text + (f" <- {body_text}" if body_text else "")


def _write_step(step: Term, depth: int) -> str:
    operator, operands = step_parts(step)
    written = ["{ " + _write(o, depth + 1) + " }" if _is_body(o) else _write(o, depth + 1) for o in operands]
    if operator == "if":
        rest = f" else {written[2]}" if len(written) > 2 else ""
        return f"if ({written[0]}) {written[1]}{rest}"
    if operator in ("while", "for"):
        return f"{operator} ({written[0]}) {written[1]}"
    if operator in ("|&|", "|||"):
        return f" {operator} ".join(written)
    return operator + written[0]


def _is_body(term: Term) -> bool:
    return term.__class__ is tuple and term[0] is BODY_SEQUENCE


def _write_object(term: Term, depth: int) -> str:
    if isinstance(term, SetValue):
        return "{" + ",".join(_write(i, depth + 1) for i in term) + "}"
    if isinstance(term, MapValue):
        pairs = ((_write(key, depth + 1), _write(term.items[key], depth + 1)) for key in term)
        return "{" + ",".join(f"{key}->{value}" for key, value in pairs) + "}"
    if isinstance(term, QueueValue):
        return "[" + ",".join(_write(i, depth + 1) for i in term) + "]"
    if isinstance(term, Reference):
        return f"cobj_{term.number}"
    return str(term)
