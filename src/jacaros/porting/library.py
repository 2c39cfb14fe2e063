"""Methods of Java's strings, numbers and collections in Python."""

from __future__ import annotations

import re

from jacaros.porting.scope import ATOM, BITS, CHOICE, COMPARE, NOT, PLUS, TIMES, Py
from jacaros.porting.types import (
    BOOLEAN,
    BUILDERS,
    DOUBLE,
    INT,
    INTEGERS,
    LISTS,
    MAPS,
    SETS,
    STACKS,
    STRING,
    TEXTS,
    VOID,
    JavaType,
)

CLASSES = frozenset(
    {"Math", "Integer", "Double", "Long", "Float", "Boolean", "String", "Arrays", "Collections", "List"}
)
_NUMBERS = {
    "intValue": INT,
    "doubleValue": DOUBLE,
    "longValue": INT,
    "floatValue": DOUBLE,
    "booleanValue": BOOLEAN,
}

# In templates, 0 is the object, and 1 and 2 are the arguments: {0} where an operator follows, <0> inside brackets.
_Template = tuple[str, JavaType | None] | tuple[str, JavaType | None, int]
"""The Python text, the type of the result (None for that of the elements), and how tightly it binds (default: ATOM)."""
_Templates = dict[tuple[str, int], _Template]

_OF_TEXTS: _Templates = {
    ("length", 0): ("len(<0>)", INT),
    ("isEmpty", 0): ("not {0}", BOOLEAN, NOT),
    ("charAt", 1): ("{0}[<1>]", JavaType("char")),
    ("substring", 1): ("{0}[<1>:]", STRING),
    ("substring", 2): ("{0}[<1>:<2>]", STRING),
    ("indexOf", 1): ("{0}.find(<1>)", INT),
    ("indexOf", 2): ("{0}.find(<1>, <2>)", INT),
    ("lastIndexOf", 1): ("{0}.rfind(<1>)", INT),
    ("contains", 1): ("{1} in {0}", BOOLEAN, COMPARE),
    ("startsWith", 1): ("{0}.startswith(<1>)", BOOLEAN),
    ("endsWith", 1): ("{0}.endswith(<1>)", BOOLEAN),
    ("toUpperCase", 0): ("{0}.upper()", STRING),
    ("toLowerCase", 0): ("{0}.lower()", STRING),
    ("trim", 0): ("{0}.strip()", STRING),
    ("strip", 0): ("{0}.strip()", STRING),
    ("replace", 2): ("{0}.replace(<1>, <2>)", STRING),
    ("replaceAll", 2): ("re.sub(<1>, {2}, <0>)", STRING),
    ("matches", 1): ("re.fullmatch(<1>, <0>) is not None", BOOLEAN, COMPARE),
    ("split", 1): ("re.split(<1>, <0>)", JavaType("[]", (STRING,))),
    ("concat", 1): ("{0} + {1}", STRING, PLUS),
    ("equalsIgnoreCase", 1): ("{0}.lower() == {1}.lower()", BOOLEAN, COMPARE),
    ("repeat", 1): ("{0} * {1}", STRING, TIMES),
    ("toString", 0): ("{0}", STRING),
}
_OF_LISTS: _Templates = {
    ("size", 0): ("len(<0>)", INT),
    ("isEmpty", 0): ("not {0}", BOOLEAN, NOT),
    ("get", 1): ("{0}[<1>]", None),
    ("elementAt", 1): ("{0}[<1>]", None),
    ("contains", 1): ("{1} in {0}", BOOLEAN, COMPARE),
    ("indexOf", 1): ("{0}.index(<1>) if {1} in {0} else -1", INT, CHOICE),
    ("getFirst", 0): ("{0}[0]", None),
    ("firstElement", 0): ("{0}[0]", None),
    ("element", 0): ("{0}[0]", None),
    ("getLast", 0): ("{0}[-1]", None),
    ("lastElement", 0): ("{0}[-1]", None),
    ("peek", 0): ("({0}[0] if {0} else None)", None),
    ("peekFirst", 0): ("({0}[0] if {0} else None)", None),
    ("peekLast", 0): ("({0}[-1] if {0} else None)", None),
    ("poll", 0): ("({0}.pop(0) if {0} else None)", None),
    ("pollFirst", 0): ("({0}.pop(0) if {0} else None)", None),
    ("pollLast", 0): ("({0}.pop() if {0} else None)", None),
    ("remove", 0): ("{0}.pop(0)", None),
    ("removeFirst", 0): ("{0}.pop(0)", None),
    ("removeLast", 0): ("{0}.pop()", None),
    ("pop", 0): ("{0}.pop(0)", None),
    ("toArray", 0): ("list(<0>)", JavaType("[]")),
    ("toArray", 1): ("list(<0>)", JavaType("[]")),
    ("clone", 0): ("list(<0>)", JavaType("List")),
    ("equals", 1): ("{0} == {1}", BOOLEAN, COMPARE),
}
_DO_LISTS: dict[tuple[str, int], str] = {
    ("add", 1): "{0}.append(<1>)",
    ("addLast", 1): "{0}.append(<1>)",
    ("addElement", 1): "{0}.append(<1>)",
    ("offer", 1): "{0}.append(<1>)",
    ("put", 1): "{0}.append(<1>)",
    ("add", 2): "{0}.insert(<1>, <2>)",
    ("addFirst", 1): "{0}.insert(0, <1>)",
    ("push", 1): "{0}.insert(0, <1>)",
    ("addAll", 1): "{0}.extend(<1>)",
    ("set", 2): "{0}[<1>] = <2>",
    ("clear", 0): "{0}.clear()",
    ("removeAllElements", 0): "{0}.clear()",
    ("removeIf", 1): "{0}[:] = [each for each in {0} if not (<1>)(each)]",
}
"""Calls whose results are not used."""
_OF_STACKS: _Templates = {
    ("pop", 0): ("{0}.pop()", None),
    ("peek", 0): ("{0}[-1]", None),
    ("empty", 0): ("not {0}", BOOLEAN, NOT),
}
_DO_STACKS = {("push", 1): "{0}.append(<1>)"}
_OF_MAPS: _Templates = {
    ("size", 0): ("len(<0>)", INT),
    ("isEmpty", 0): ("not {0}", BOOLEAN, NOT),
    ("get", 1): ("{0}.get(<1>)", None),
    ("getOrDefault", 2): ("{0}.get(<1>, <2>)", None),
    ("containsKey", 1): ("{1} in {0}", BOOLEAN, COMPARE),
    ("containsValue", 1): ("{1} in {0}.values()", BOOLEAN, COMPARE),
    ("remove", 1): ("{0}.pop(<1>, None)", None),
    ("keySet", 0): ("list(<0>)", None),
    ("values", 0): ("list({0}.values())", None),
}
_DO_MAPS = {
    ("put", 2): "{0}[<1>] = <2>",
    ("putIfAbsent", 2): "{0}.setdefault(<1>, <2>)",
    ("putAll", 1): "{0}.update(<1>)",
    ("clear", 0): "{0}.clear()",
}
_OF_SETS: _Templates = {
    ("size", 0): ("len(<0>)", INT),
    ("isEmpty", 0): ("not {0}", BOOLEAN, NOT),
    ("contains", 1): ("{1} in {0}", BOOLEAN, COMPARE),
}
_DO_SETS = {
    ("add", 1): "{0}.add(<1>)",
    ("addAll", 1): "{0}.update(<1>)",
    ("remove", 1): "{0}.discard(<1>)",
    ("removeAll", 1): "{0}.difference_update(<1>)",
    ("clear", 0): "{0}.clear()",
}
_OF_RANDOM: _Templates = {
    ("nextInt", 1): ("{0}.randrange(<1>)", INT),
    ("nextDouble", 0): ("{0}.random()", DOUBLE),
    ("nextFloat", 0): ("{0}.random()", DOUBLE),
    ("nextBoolean", 0): ("{0}.random() < 0.5", BOOLEAN, COMPARE),
    ("nextGaussian", 0): ("{0}.gauss(0, 1)", DOUBLE),
}
_FUNCTIONS: dict[tuple[str, str, int], _Template] = {
    **{
        ("Math", name, 1): (f"math.{name}(<0>)", DOUBLE)
        for name in ("sqrt", "sin", "cos", "tan", "exp", "log", "log10", "asin", "acos", "atan", "hypot")
    },
    ("Math", "abs", 1): ("abs(<0>)", None),
    ("Math", "max", 2): ("max(<0>, <1>)", None),
    ("Math", "min", 2): ("min(<0>, <1>)", None),
    ("Math", "pow", 2): ("math.pow(<0>, <1>)", DOUBLE),
    ("Math", "atan2", 2): ("math.atan2(<0>, <1>)", DOUBLE),
    ("Math", "hypot", 2): ("math.hypot(<0>, <1>)", DOUBLE),
    ("Math", "toRadians", 1): ("math.radians(<0>)", DOUBLE),
    ("Math", "toDegrees", 1): ("math.degrees(<0>)", DOUBLE),
    ("Math", "round", 1): ("math.floor({0} + 0.5)", INT),
    ("Math", "floor", 1): ("float(math.floor(<0>))", DOUBLE),
    ("Math", "ceil", 1): ("float(math.ceil(<0>))", DOUBLE),
    ("Math", "random", 0): ("random.random()", DOUBLE),
    ("Integer", "parseInt", 1): ("int(<0>)", INT),
    ("Integer", "valueOf", 1): ("int(<0>)", INT),
    ("Integer", "toString", 1): ("str(<0>)", STRING),
    ("Long", "parseLong", 1): ("int(<0>)", INT),
    ("Long", "valueOf", 1): ("int(<0>)", INT),
    ("Double", "parseDouble", 1): ("float(<0>)", DOUBLE),
    ("Double", "valueOf", 1): ("float(<0>)", DOUBLE),
    ("Float", "parseFloat", 1): ("float(<0>)", DOUBLE),
    ("Boolean", "parseBoolean", 1): ('({0}.lower() == "true")', BOOLEAN),
    ("Boolean", "valueOf", 1): ("{0}", BOOLEAN),
    ("String", "valueOf", 1): ("text(<0>)", STRING),
    ("Collections", "emptyList", 0): ("[]", JavaType("List")),
    ("Collections", "sort", 1): ("{0}.sort()", VOID),
    ("Collections", "reverse", 1): ("{0}.reverse()", VOID),
    ("Collections", "shuffle", 1): ("random.shuffle(<0>)", VOID),
}


def method(thing: Py, name: str, values: list[Py], is_statement: bool) -> Py | None:
    """Translate a method of an object of the library; None if it has no translation."""
    kind, key = thing.type.name, (name, len(values))
    if name == "equals" and len(values) == 1:
        return Py(f"{thing.within(BITS)} == {values[0].within(BITS)}", BOOLEAN, COMPARE)
    if name in _NUMBERS and not values:
        return Py(thing.text, _NUMBERS[name], thing.tight)
    if kind in BUILDERS and key == ("append", 1) and is_statement:
        added = values[0]
        text = added.text if added.type.name in TEXTS else f"text({added.text})"
        return Py(f"{thing.text} += {text}", VOID)
    if kind in LISTS and key == ("remove", 1):
        return _removed(thing, values[0], is_statement)
    for names, known, done in (
        (TEXTS, _OF_TEXTS, {}),
        (STACKS, _OF_STACKS, _DO_STACKS),
        (LISTS, _OF_LISTS, _DO_LISTS),
        (MAPS, _OF_MAPS, _DO_MAPS),
        (SETS, _OF_SETS, _DO_SETS),
        (("Random",), _OF_RANDOM, {}),
    ):
        if kind in names and is_statement and key in done:
            return Py(_filled(done[key], [thing, *values]), VOID)
        if kind in names and key in known:
            text, result, tight = _complete(known[key])
            if key == ("keySet", 0):
                result = JavaType("Set", (thing.type.element(0),))
            elif key == ("values", 0):
                result = JavaType("List", (thing.type.element(),))
            if key == ("split", 1) and re.fullmatch(r'"[^\\\[\](){}.*+?^$|]+"', values[0].text):
                text = "{0}.split(<1>)"
            return Py(_filled(text, [thing, *values]), result or thing.type.element(), tight)
    return None


def _removed(thing: Py, what: Py, is_statement: bool) -> Py | None:
    if what.type.name in INTEGERS and what.type.name.islower():
        return Py(f"{thing.atom}.pop({what.text})", thing.type.element())
    # Java ignores an element that is not there.
    return (
        Py(f"if {what.within(BITS)} in {thing.within(BITS)}:\n    {thing.atom}.remove({what.text})", VOID)
        if is_statement
        else None
    )


def function(owner: str, name: str, values: list[Py]) -> Py | None:
    """Translate a static method of the library; None if it has no translation."""
    if (owner, name) in (("Arrays", "asList"), ("List", "of")):
        return Py(
            f"[{', '.join(each.text for each in values)}]",
            JavaType("List", (values[0].type,) if values else ()),
        )
    if (
        (owner, name) == ("String", "format")
        and values
        and re.fullmatch(r'"([^%]|%(\.\d+)?[sdf%])*"', values[0].text)
    ):
        given = ", ".join(each.text for each in values[1:])
        return Py(f"{values[0].text} % ({given},)", STRING, TIMES)
    if (owner, name) == ("Arrays", "toString") and len(values) == 1:
        return Py(f"text({values[0].text})", STRING)
    found = _FUNCTIONS.get((owner, name, len(values)))
    if found is None:
        return None
    text, result, tight = _complete(found)
    numbers = INT if all(each.type.name in INTEGERS for each in values) else DOUBLE
    return Py(_filled(text, values), result or numbers, tight)


def _complete(template: _Template) -> tuple[str, JavaType | None, int]:
    return template if len(template) == 3 else (*template, ATOM)


def _filled(template: str, values: list[Py]) -> str:
    def put(match: re.Match[str]) -> str:
        return values[int(match[1])].atom if match[1] else values[int(match[2])].text

    return re.sub(r"\{(\d)\}|<(\d)>", put, template)
