"""Expressions of Java in Python."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TYPE_CHECKING

from jacaros.porting import calls
from jacaros.porting.model import JavaClass
from jacaros.porting.reading import children, field, source
from jacaros.porting.scope import (
    AND,
    ATOM,
    BITS,
    CHOICE,
    COMPARE,
    NOT,
    OR,
    PLUS,
    SHIFT,
    TIMES,
    UNARY,
    Py,
    Scope,
    Unported,
)
from jacaros.porting.texts import joined, operands
from jacaros.porting.types import (
    BOOLEAN,
    BUILDERS,
    DOUBLE,
    FLOATS,
    INT,
    INTEGERS,
    LISTS,
    LOCKS,
    MAPS,
    PROPERTY,
    SETS,
    STRING,
    TERMS,
    TEXTS,
    UNKNOWN,
    JavaType,
    default_of,
    type_of,
)

if TYPE_CHECKING:
    from tree_sitter import Node

_TIGHT = {"*": TIMES, "/": TIMES, "%": TIMES, "+": PLUS, "-": PLUS, "<<": SHIFT, ">>": SHIFT}
_COMPARISONS = frozenset({"==", "!=", "<", ">", "<=", ">="})
_CONSTANTS = {
    "Integer.MAX_VALUE": Py("2147483647", INT),
    "Integer.MIN_VALUE": Py("-2147483648", INT, UNARY),
    "Long.MAX_VALUE": Py("9223372036854775807", INT),
    "Double.MAX_VALUE": Py("sys.float_info.max", DOUBLE),
    "Double.MIN_VALUE": Py("5e-324", DOUBLE),
    "Double.POSITIVE_INFINITY": Py("math.inf", DOUBLE),
    "Double.NEGATIVE_INFINITY": Py("-math.inf", DOUBLE, UNARY),
    "Math.PI": Py("math.pi", DOUBLE),
    "Math.E": Py("math.e", DOUBLE),
    "Boolean.TRUE": Py("True", BOOLEAN),
    "Boolean.FALSE": Py("False", BOOLEAN),
}
_CLASSES = {
    "String": "str",
    "Integer": "int",
    "Long": "int",
    "Double": "float",
    "Boolean": "bool",
    "Number": "(int, float)",
}


def value(node: Node, scope: Scope) -> Py:
    """Translate an expression.

    Raises:
        Unported: it has no translation.
    """
    translate = _TRANSLATED.get(node.type)
    if translate is None:
        raise Unported(node)
    return translate(node, scope)


def _literal(text: Callable[[str], str], kind: JavaType) -> Callable[[Node, Scope], Py]:
    return lambda node, _: Py(text(source(node)), kind)


def _decimal(text: str) -> str:
    digits = text.rstrip("fFdD")
    return f"{digits}0" if digits.endswith(".") else digits if re.search("[.eE]", digits) else f"{digits}.0"


def _character(text: str) -> str:
    return {"'\"'": "'\"'", r"'\''": '"\'"'}.get(text, f'"{text[1:-1]}"')


def _name(node: Node, scope: Scope) -> Py:
    name = source(node)
    if name in scope.variables:
        found = scope.variables[name]
        if found is None:
            raise Unported(node)
        return found
    return member(name, node, scope)


def member(name: str, node: Node, scope: Scope) -> Py:
    """Return a field of the class, or of the class around it."""
    own = scope.of.lineage
    for owner in (*own, *(each for each in scope.of.file.classes.values() if each not in own)):
        if found := owner.members.get(name):
            if found.is_static:
                python = owner.attribute(name)
                is_near = scope.in_class_body and owner is scope.of
                return Py(python if is_near else f"{owner.name}.{python}", found.type)
            if owner in own and not (scope.method and scope.method.is_static) and not scope.in_class_body:
                return Py(f"self.{owner.attribute(name)}", found.type)
    raise Unported(node)


def _this(node: Node, scope: Scope) -> Py:
    if scope.method is None or scope.method.is_static:
        raise Unported(node)
    return Py("self", JavaType(scope.of.name))


def _access(node: Node, scope: Scope) -> Py:
    target, name = field(node, "object"), source(field(node, "field"))
    if (constant := _CONSTANTS.get(source(node))) is not None:
        return constant
    if target.type == "this":
        return member(name, node, scope)
    owner = scope.of.file.classes.get(source(target))
    if owner is not None and source(target) not in scope.variables:
        if owner.is_enum:
            return Py(f"{owner.name}.{name}", JavaType(owner.name))
        return _of_class(name, owner, owner.name, node)
    thing = value(target, scope)
    if name == "length" and thing.type.name == "[]":
        return Py(f"len({thing.text})", INT)
    owner = scope.of.file.classes.get(thing.type.name)
    if owner is None:
        raise Unported(node)
    return _of_class(name, owner, thing.atom, node)


def _of_class(name: str, owner: JavaClass, target: str, node: Node) -> Py:
    if name not in owner.members or owner.name not in owner.file.ported:
        raise Unported(node)
    return Py(f"{target}.{owner.attribute(name)}", owner.members[name].type)


def _element(node: Node, scope: Scope) -> Py:
    array, index = value(field(node, "array"), scope), value(field(node, "index"), scope)
    return Py(f"{array.atom}[{index.text}]", array.type.element())


def _binary(node: Node, scope: Scope) -> Py:
    sign = source(field(node, "operator"))
    left_node, right_node = field(node, "left"), field(node, "right")
    if sign in ("==", "!="):
        return _compared_with(left_node, right_node, sign, node, scope)
    left, right = value(left_node, scope), value(right_node, scope)
    kind = (
        STRING
        if sign == "+" and (left.type.name in TEXTS or right.type.name in TEXTS)
        else INT
        if left.type.name in INTEGERS and right.type.name in INTEGERS
        else DOUBLE
        if left.type.is_number and right.type.is_number
        else UNKNOWN
    )
    if kind is STRING:
        if {left.type.name, right.type.name} <= {"char"}:
            raise Unported(node)  # a sum of numbers in Java
        return Py(joined(operands(node), scope, value), STRING, PLUS)
    if sign in ("&&", "||"):
        word, tight = ("and", AND) if sign == "&&" else ("or", OR)
        return Py(f"{left.within(tight)} {word} {right.within(tight + 1)}", BOOLEAN, tight)
    if sign in _COMPARISONS:
        return Py(f"{left.within(BITS)} {sign} {right.within(BITS)}", BOOLEAN, COMPARE)
    if sign == "/" and kind is INT:
        return Py(f"int({left.within(TIMES)} / {right.within(UNARY)})", INT)
    if sign == "%" and kind is not DOUBLE and not left.text.isdecimal() and not left.text.startswith("len("):
        return Py(f"int(math.fmod({left.text}, {right.text}))", INT)
    if sign in ("&", "|", "^"):
        logical = left.type.name == "boolean" or right.type.name == "boolean"
        return Py(
            f"{left.within(BITS + 1)} {sign} {right.within(BITS + 1)}", BOOLEAN if logical else INT, BITS
        )
    if sign not in _TIGHT:
        raise Unported(node)
    tight = _TIGHT[sign]
    return Py(f"{left.within(tight)} {sign} {right.within(tight + 1)}", kind, tight)


def _compared_with(left_node: Node, right_node: Node, sign: str, node: Node, scope: Scope) -> Py:
    left, right = value(left_node, scope), value(right_node, scope)
    if left.text == "None":
        left, right = right, left
    if right.text == "None":
        if left.type.name == PROPERTY:
            has = f"self.has_property({', '.join(filter(None, (left.text, left.where)))})"
            return Py(f"not {has}", BOOLEAN, NOT) if sign == "==" else Py(has, BOOLEAN)
        return Py(f"{left.within(BITS)} {'is' if sign == '==' else 'is not'} None", BOOLEAN, COMPARE)
    if right.text in ("True", "False"):
        same = (right.text == "True") == (sign == "==")
        return left if same else negated(left)
    return Py(f"{left.within(BITS)} {sign} {right.within(BITS)}", BOOLEAN, COMPARE)


def negated(thing: Py) -> Py:
    """Return the opposite of a condition."""
    for sign, opposite in (
        (" == ", " != "),
        (" is None", " is not None"),
        (" not in ", " in "),
        (" in ", " not in "),
    ):
        if thing.tight == COMPARE and thing.text.count(" ") in (2, 3) and sign in thing.text:
            return Py(thing.text.replace(sign, opposite), BOOLEAN, COMPARE)
    if thing.text.startswith("not ") and thing.tight == NOT:
        return Py(thing.text.removeprefix("not "), BOOLEAN, NOT)
    return Py(f"not {thing.within(NOT)}", BOOLEAN, NOT)


def _unary(node: Node, scope: Scope) -> Py:
    sign, operand = source(field(node, "operator")), value(field(node, "operand"), scope)
    if sign == "!":
        return negated(operand)
    return Py(f"{sign}{operand.within(UNARY)}", operand.type, UNARY)


def _update(node: Node, scope: Scope) -> Py:
    """Translate ``i++`` inside an expression: the variable changes after, or before, the whole statement."""
    first = node.children[0]
    is_after = first.is_named
    target = value(first if is_after else node.children[1], scope)
    change = f"{target.text} {source(node.children[1 if is_after else 0])[0]}= 1"
    (scope.after if is_after else scope.before).append(change)
    return target


def _parenthesized(node: Node, scope: Scope) -> Py:
    return value(children(node)[0], scope)


def _choice(node: Node, scope: Scope) -> Py:
    condition, first, second = (
        value(field(node, name), scope) for name in ("condition", "consequence", "alternative")
    )
    text = f"{first.within(OR)} if {condition.within(OR)} else {second.within(CHOICE)}"
    return Py(text, first.type if first.text != "None" else second.type, CHOICE)


def _assignment(node: Node, scope: Scope) -> Py:
    """Translate ``x = y`` inside an expression, which is possible on the right of another assignment."""
    parent = node.parent
    if source(field(node, "operator")) != "=" or parent is None or parent.type != "assignment_expression":
        raise Unported(node)
    left, right = value(field(node, "left"), scope), value(field(node, "right"), scope)
    return Py(f"{left.text} = {right.text}", left.type, ATOM)


def _cast(node: Node, scope: Scope) -> Py:
    kind, thing = type_of(field(node, "type")), value(field(node, "value"), scope)
    if kind.name in INTEGERS and (thing.type.name in FLOATS or thing.type.name in TERMS):
        return Py(f"int({thing.text})", kind)
    if kind.name in FLOATS and thing.type.name not in FLOATS:
        return Py(f"float({thing.text})", kind)
    if kind.name == "char" and thing.type.name in INTEGERS:
        return Py(f"chr({thing.text})", kind)
    return Py(thing.text, kind, thing.tight, thing.where)


def _instance(node: Node, scope: Scope) -> Py:
    thing, kind = value(field(node, "left"), scope), type_of(field(node, "right")).name
    python = _CLASSES.get(kind, kind if kind in scope.of.file.ported else "")
    python = python or (
        "list" if kind in LISTS else "dict" if kind in MAPS else "set" if kind in SETS else ""
    )
    if not python:
        raise Unported(node)
    return Py(f"isinstance({thing.text}, {python})", BOOLEAN)


def _array(node: Node, scope: Scope) -> Py:
    kind = type_of(field(node, "type"))
    initial = node.child_by_field_name("value")
    if initial is not None:
        return Py(value(initial, scope).text, JavaType("[]", (kind,)))
    sizes = [
        value(children(each)[0], scope)
        for each in node.children_by_field_name("dimensions")
        if children(each)
    ]
    text = f"[{default_of(kind)}] * {sizes[-1].within(TIMES + 1)}"
    array = JavaType("[]", (kind,))
    for size in reversed(sizes[:-1]):
        text = f"[{text} for _ in range({size.text})]"
        array = JavaType("[]", (array,))
    return Py(text, array, TIMES if len(sizes) == 1 else ATOM)


def _array_values(node: Node, scope: Scope) -> Py:
    values = [value(each, scope) for each in children(node)]
    kind = values[0].type if values else UNKNOWN
    return Py(f"[{', '.join(each.text for each in values)}]", JavaType("[]", (kind,)))


def _creation(node: Node, scope: Scope) -> Py:
    kind = type_of(field(node, "type"))
    if any(each.type == "class_body" for each in node.children):
        raise Unported(node)
    arguments = [value(each, scope) for each in children(field(node, "arguments"))]
    first = arguments[0] if arguments else None
    made: str | None = None
    if kind.name in LISTS or kind.name in SETS:
        word = "list" if kind.name in LISTS else "set"
        is_copy = first is not None and (
            first.type.name in LISTS or first.type.name in SETS or first.type.name == "?"
        )
        copied = (
            first.text.removeprefix("list(").removesuffix(")")
            if first and first.text.startswith("list(")
            else first and first.text
        )
        made = f"{word}({copied})" if is_copy else "[]" if word == "list" else "set()"
    elif kind.name in MAPS:
        made = f"dict({first.text})" if first and first.type.name in MAPS else "{}"
    elif kind.name in BUILDERS or kind.name == "String":
        made = first.text if first and first.type.name in TEXTS else '""'
    elif kind.name == "Random":
        made = f"random.Random({first.text if first else ''})"
    elif kind.name in ("Integer", "Double", "Long", "Boolean") and first:
        return Py(first.text, kind, first.tight)
    elif kind.name in ("Atom", "StringTermImpl", "NumberTermImpl") and first:
        made = f"Atom({first.text})" if kind.name == "Atom" else first.text
    elif kind.name == "OpFeedbackParam":
        made = "Out()"
    elif (kind.name == "Object" or kind.name in LOCKS) and not arguments:
        made = "object()"
    elif kind.name in scope.of.file.ported:
        owner = scope.of.file.classes[kind.name]
        if owner.is_plain and _can_make(owner, len(arguments)):
            made = f"{kind.name}({', '.join(each.text for each in arguments)})"
    if made is None:
        raise Unported(node)
    return Py(made, kind)


def _can_make(owner: JavaClass, count: int) -> bool:
    constructors = [each for each in owner.methods if each.name == "__init__"]
    return any(each.accepts(count) for each in constructors) if constructors else count == 0


def _lambda(node: Node, scope: Scope) -> Py:
    body, parameters = field(node, "body"), field(node, "parameters")
    if body.type == "block" or parameters.type not in ("identifier", "inferred_parameters"):
        raise Unported(node)
    names = [parameters] if parameters.type == "identifier" else children(parameters)
    outside = dict(scope.variables)
    text = ", ".join(scope.declare(source(name), UNKNOWN) for name in names)
    result = value(body, scope)
    scope.variables = outside
    return Py(f"lambda {text}: {result.text}", UNKNOWN, CHOICE)


_TRANSLATED: dict[str, Callable[[Node, Scope], Py]] = {
    "decimal_integer_literal": _literal(lambda text: (text.rstrip("lL").lstrip("0") or "0").lstrip("_"), INT),
    "hex_integer_literal": _literal(lambda text: text.rstrip("lL"), INT),
    "decimal_floating_point_literal": _literal(_decimal, DOUBLE),
    "string_literal": _literal(lambda text: text, STRING),
    "character_literal": _literal(_character, JavaType("char")),
    "true": _literal(str.capitalize, BOOLEAN),
    "false": _literal(str.capitalize, BOOLEAN),
    "null_literal": _literal(lambda _: "None", UNKNOWN),
    "identifier": _name,
    "this": _this,
    "field_access": _access,
    "array_access": _element,
    "binary_expression": _binary,
    "unary_expression": _unary,
    "update_expression": _update,
    "parenthesized_expression": _parenthesized,
    "ternary_expression": _choice,
    "assignment_expression": _assignment,
    "cast_expression": _cast,
    "instanceof_expression": _instance,
    "array_creation_expression": _array,
    "array_initializer": _array_values,
    "object_creation_expression": _creation,
    "lambda_expression": _lambda,
    "method_invocation": lambda node, scope: calls.call(node, scope, value),
}
