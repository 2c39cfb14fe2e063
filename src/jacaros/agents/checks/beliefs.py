"""Findings about beliefs: names, numbers of arguments and values that nothing gives them.

>>> from jacaros.agents.checks.flow import Flow, flows_of
>>> from jacaros.agents.language.loader import load_program
>>> program, _ = load_program("robot.asl", 'mode("idle"). +!go : mode(idle).')
>>> [flow] = flows_of([program], {})
>>> [each.message for each in mismatches(flow, Flow([flow]).adders(flow))]
['`mode(idle)` never matches: `idle` is an atom, but the only value of `mode/1` is the string `"idle"`']
>>> is_misspelt("batery", "battery"), is_misspelt("room1", "room2")
(True, False)
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import replace
from math import pi
from typing import Final

from jacaros.agents.checks.flow import (
    Adder,
    Columns,
    ProgramFlow,
    Reader,
    Value,
    is_own,
    key_of,
    of_size,
    place_of,
    value_of,
    variables_of,
)
from jacaros.agents.checks.formulas import Key
from jacaros.agents.language import nodes
from jacaros.agents.language.cursor import is_slip_of
from jacaros.agents.language.diagnostics import Diagnostic, problem
from jacaros.agents.language.lowering import format_term
from jacaros.agents.language.nodes import nodes_in
from jacaros.runtime.files.texts import close_matches, did_you_mean

MISMATCH: Final = "never-matches"
UNIT: Final = "wrong-unit"

_SHORTEST: Final = 5
"""Names shorter than this are too easily similar; one letter less will do if only letters are swapped."""
_SHORTEST_PART: Final = 3
"""Parts of names between underscores that are shorter than this are too easily similar."""
_ENDINGS: Final = "sdr"
"""Letters that make another form of a word."""
_FEWEST_FACTS: Final = 3
"""Of so many facts, the one that differs is probably wrong."""
_TERM: Final = re.compile(r"[a-z]\w*(\(.*\))?")
_MOST_OPTIONS: Final = 8
"""Number of values that are listed."""


# Names.


def is_misspelt(written: str, meant: str) -> bool:
    """Return whether *written* is clearly a misspelling of *meant*.

    Names with digits (``room1``, ``room2``), plurals and other forms of a word (``close``, ``closed``), short names,
    names with different first letters, and those that differ in a short part (``pos_x``, ``pos_y``) are names of their
    own.
    """
    shortest = _SHORTEST - (sorted(written) == sorted(meant))
    if len(meant) < shortest or written[0] != meant[0] or not is_slip_of(written, meant):
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


# Values.


def mismatches(flow: ProgramFlow, adders: Mapping[str, Sequence[Adder]]) -> Iterator[Diagnostic]:
    """Return warnings about beliefs that are asked for with values that nothing gives them.

    Args:
        flow: a program.
        adders: all that can give its agent beliefs, by name.
    """
    for reader in filter(lambda each: is_own(each.literal), flow.readers):
        yield from _mismatch(reader, of_size(adders, reader.key))


def comparisons(flow: ProgramFlow, adders: Mapping[str, Sequence[Adder]]) -> Iterator[Diagnostic]:
    """Return warnings about values of beliefs that are compared with other kinds, or numbers in other units."""
    clauses = {id(each.clause): each.clause for each in flow.readers if is_own(each.literal)}
    columns: Columns = {}
    for clause in clauses.values():
        if relations := list(nodes_in(nodes.Relation, clause)):
            yield from _comparisons(relations, variables_of(clause, adders, columns))


def unmet_goals(program: nodes.Program, adders: Mapping[str, Sequence[Adder]]) -> Iterator[Diagnostic]:
    """Return warnings about goals with an argument for which the context of no plan holds."""
    plans: dict[Key, list[nodes.Plan]] = {}
    for plan in program.plans:
        trigger = plan.trigger
        if (trigger.operator, trigger.kind) == ("+", "!"):
            if not isinstance(trigger.literal, nodes.Literal):
                return
            if not _refuses(plan):
                plans.setdefault(key_of(trigger.literal), []).append(plan)
    posted = [*program.goals, *(step.goal for step in program.found.of(nodes.Achieve))]
    for goal in posted:
        if not isinstance(goal, nodes.Literal) or not is_own(goal):
            continue
        for place, argument in enumerate(goal.arguments):
            if value_of(argument, {}).kind:
                found = [_unmet(plan, place, argument, adders) for plan in plans.get(key_of(goal), ())]
                if found and (first := found[0]) and all(found):
                    yield replace(first, message=f"no plan for `!{as_written(goal)}`: {first.message}")


def _refuses(plan: nodes.Plan) -> bool:
    """Return whether a plan ends in ``.fail``: it only says why no other plan applies."""
    last = plan.body.steps[-1:] if isinstance(plan.body, nodes.Body) else ()
    calls = (each.formula for each in last if isinstance(each, nodes.Constraint))
    return any(isinstance(each, nodes.InternalAction) and each.name == ".fail" for each in calls)


def _unmet(
    plan: nodes.Plan, place: int, argument: nodes.Term, adders: Mapping[str, Sequence[Adder]]
) -> Diagnostic | None:
    """Explain why the context of a plan for a goal never holds with this argument."""
    literal, context = plan.trigger.literal, plan.context
    variable = literal.arguments[place] if isinstance(literal, nodes.Literal) else None
    parts = nodes.operands(context) if isinstance(context, nodes.And) else [context]
    for part in parts if isinstance(variable, nodes.Variable) else ():
        if isinstance(part, nodes.Literal) and variable in part.arguments:
            filled = tuple([argument if each == variable else each for each in part.arguments])
            reader = Reader("condition", nodes.replace(part, arguments=filled), plan)
            return next(_mismatch(reader, of_size(adders, reader.key)), None)
    return None


def unawaited(program: nodes.Program, adders: Mapping[str, Sequence[Adder]]) -> Iterator[Diagnostic]:
    """Return notes about test goals for one number of a measurement that no earlier step of the plan waits for."""
    for plan in filter(is_own, program.plans):
        steps = plan.body.steps if isinstance(plan.body, nodes.Body) else ()
        for number, step in enumerate(steps):
            if isinstance(step, nodes.Achieve):
                break  # its plans may wait
            if isinstance(step, nodes.Test) and isinstance(asked := step.formula, nodes.Literal):
                numbers = [at for at, each in enumerate(asked.arguments) if isinstance(each, nodes.Number)]
                given = [place_of(each, numbers[0]) for each in of_size(adders, key_of(asked)) if numbers]
                is_measured = bool(given) and all(
                    each.kind == "number" and not each.options for each in given
                )
                before = nodes_in(nodes.Literal, (plan.trigger, *steps[:number])) if is_measured else ()
                if is_measured and all(each.functor != asked.functor for each in before):
                    text = as_written(asked)
                    message = f"`?{text}` fails unless the value is exactly this one when it is tested"
                    yield problem(
                        "unawaited-value", message, step.span, f"wait for it before: `.wait({text})`"
                    )


def capital_atoms(flow: ProgramFlow, adders: Mapping[str, Sequence[Adder]]) -> Iterator[Diagnostic]:
    """Return warnings about variables, used once, that are called as the only value that a belief has."""
    for reader in filter(lambda each: is_own(each.literal), flow.readers):
        given = of_size(adders, reader.key)
        for place, argument in enumerate(reader.literal.arguments if given else ()):
            name = argument.name if isinstance(argument, nodes.Variable) and not argument.unnamed else ""
            lower = name[:1].lower() + name[1:]
            is_only = name and all(place_of(each, place).options == (lower,) for each in given)
            if is_only and nodes.occurrences(reader.clause).get(name) == 1:
                message = f"`{name}` is a variable (capital {name[0]}), which matches any value"
                yield problem("singleton-variable", message, argument.span, did_you_mean([lower]))


def mixed_facts(flow: ProgramFlow) -> Iterator[Diagnostic]:
    """Return warnings about a string among the atoms of initial beliefs, or an atom among strings."""
    known = [each.literal for adders in flow.adders.values() for each in adders if each.how == "fact"]
    texts = {_kind_andas_written(term) for fact in known if fact for term in fact.arguments}
    for adders in flow.adders.values():
        facts: dict[int, list[nodes.Literal]] = {}
        for each in adders:
            if each.how == "fact" and each.literal is not None and is_own(each.literal):
                facts.setdefault(len(each.literal.arguments), []).append(each.literal)
        for size, literals in facts.items():
            for place in range(size if len(literals) > 1 else 0):
                yield from _odd_one(literals, place, texts)


def _kind_andas_written(term: nodes.Node) -> tuple[str, str]:
    return value_of(term, {}).kind, term.value if isinstance(term, nodes.String) else format_term(term)


def _odd_one(facts: Sequence[nodes.Literal], place: int, texts: Set[tuple[str, str]]) -> Iterator[Diagnostic]:
    kinds = [value_of(each.arguments[place], {}).kind for each in facts]
    for kind, usual in (("string", "atom"), ("atom", "string")):
        if kinds.count(kind) == 1 and kinds.count(usual) == len(kinds) - 1:
            odd = facts[kinds.index(kind)].arguments[place]
            # Of two facts, the one whose value other facts have in the other kind.
            if len(facts) < _FEWEST_FACTS and (usual, _kind_andas_written(odd)[1]) not in texts:
                continue
            name, size = key_of(facts[0])
            others = f"the other facts `{name}/{size}` have {_KINDS[usual]} here"
            message = f"`{format_term(odd)}` is {_KINDS[kind]}, but {others}"
            yield problem(MISMATCH, message, odd.span, _in_kind(odd, Value(usual)))


def told_texts(flow: ProgramFlow) -> Iterator[Diagnostic]:
    """Return warnings about strings in `tell` messages: agents refuse them."""
    for each in flow.texts:
        message = f"`{format_term(each)}` is a string, which is not a belief: the receiver refuses it"
        yield problem(MISMATCH, message, each.span, _in_kind(each, Value("atom")))


def _mismatch(reader: Reader, same: Sequence[Adder]) -> Iterator[Diagnostic]:
    literal = reader.literal
    for place, argument in enumerate(literal.arguments if same else ()):
        wanted = value_of(argument, {})
        if wanted.kind and not any(place_of(each, place).fits(wanted) for each in same):
            given = [place_of(each, place) for each in same]
            kinds = {each.kind for each in given}
            if wanted.kind in kinds and (reader.denied or reader.how == "deletion"):
                continue
            has = _described(given, literal, place)
            is_ = (
                f"`{as_written(argument)}` is {_KINDS[wanted.kind]}, but " if wanted.kind not in kinds else ""
            )
            message = f"`{as_written(literal)}` never matches: {is_}{has}"
            help = _help(literal, same, place) or _in_kind(argument, given[0])
            yield problem(MISMATCH, message, argument.span or literal.span, help)
            return


_KINDS: Final = {
    "number": "a number",
    "string": "a string",
    "atom": "an atom",
    "list": "a list",
    "structure": "a structure",
}


def _described(given: Sequence[Value], literal: nodes.Literal, place: int) -> str:
    """Describe the values that an argument has."""
    name, size = key_of(literal)
    of = f"`{name}/{size}`" if size == 1 else f"argument {place + 1} of `{name}/{size}`"
    options = list(dict.fromkeys(option for each in given for option in each.options))
    if all(each.options for each in given) and len(options) <= _MOST_OPTIONS:
        kinds = {each.kind for each in given}
        word = f"the {kinds.pop()} " if len(kinds) == 1 == len(options) else ""
        are = "values of {} are" if len(options) > 1 else "value of {} is"
        return f"the only {are.format(of)} {word}{', '.join(f'`{each}`' for each in options)}"
    words = dict.fromkeys(_KINDS[each.kind] + (f" in {each.unit}" if each.unit else "") for each in given)
    return f"{of} has {' or '.join(words)}"


def _help(literal: nodes.Literal, same: Sequence[Adder], place: int) -> str:
    wanted = literal.arguments[place]
    given = [place_of(each, place) for each in same]
    if isinstance(wanted, nodes.Literal) and any(
        each.kind == "number" and not each.options for each in given
    ):
        return f"begin variables with a capital letter: `{as_written(_with_variables(literal, same))}`"
    options = list(dict.fromkeys(option for each in given for option in each.options))
    near = close_matches(as_written(wanted), options) or options[:_MOST_OPTIONS]
    if not near and isinstance(wanted, nodes.String) and any(each.kind == "atom" for each in given):
        near = [str(wanted.value)]
    texts = list(map(as_written, literal.arguments))
    lists = (", ".join([*texts[:place], option, *texts[place + 1 :]]) for option in near)
    return did_you_mean(f"{literal.functor}({each})" for each in lists)


def as_written(node: nodes.Node) -> str:
    """Write a term as people do."""
    match node:
        case nodes.Variable(unnamed=True):
            return "_"
        case nodes.Literal(functor=functor, arguments=arguments) if arguments:
            return f"{'~' * node.negated}{functor}({', '.join(map(as_written, arguments))})"
        case nodes.Relation(operator=operator, left=left, right=right):
            return f"{as_written(left)} {operator} {as_written(right)}"
    return format_term(node)


def _with_variables(literal: nodes.Literal, same: Sequence[Adder]) -> nodes.Literal:
    """Return a literal with a variable for each atom that never fits."""
    arguments = [
        nodes.Variable(argument.functor[:1].upper() + argument.functor[1:])
        if isinstance(argument, nodes.Literal)
        and not argument.arguments
        and not any(place_of(each, place).fits(value_of(argument, {})) for each in same)
        else argument
        for place, argument in enumerate(literal.arguments)
    ]
    return nodes.replace(literal, arguments=tuple(arguments))


# Comparisons and units.

_FACTORS: Final = {
    "radians": ("angle", 1.0),
    "degrees": ("angle", pi / 180),
    "radians per second": ("turn rate", 1.0),
    "degrees per second": ("turn rate", pi / 180),
    "metres": ("length", 1.0),
    "centimetres": ("length", 0.01),
    "millimetres": ("length", 0.001),
    "seconds": ("time", 1.0),
    "milliseconds": ("time", 0.001),
    "minutes": ("time", 60.0),
    "0 to 1": ("share", 1.0),
    "percent": ("share", 0.01),
}
"""The units that may be mixed up: what they measure, and their sizes."""
_TURN: Final = 10.0
"""No comparison is with so many radians: that is more than a turn."""


def _comparisons(relations: Iterable[nodes.Relation], variables: Mapping[str, Value]) -> Iterator[Diagnostic]:
    for relation in relations:
        for variable, other in (relation.operands, relation.operands[::-1]):
            value = variables.get(variable.name) if isinstance(variable, nodes.Variable) else None
            if value is None or not value.kind:
                continue
            wanted = value_of(other, {})
            if wanted.kind and not value.fits(wanted) and wanted.kind != value.kind:
                message = f"`{as_written(relation)}` compares {_KINDS[value.kind]} with {_KINDS[wanted.kind]}"
                yield problem(MISMATCH, message, relation.span, _in_kind(other, value))
            elif isinstance(other, nodes.Number) and (unit := _unit_of(other.value, value)):
                name, number = format_term(variable), format_term(other)
                message = f"`{name}` is in {_named(value.unit)}, but `{number}` is in {_named(unit)}"
                help = f"write `{other.value * _factor(unit, value.unit):.6g}`"
                yield problem(UNIT, message, relation.span, help)


def _in_kind(other: nodes.Node, value: Value) -> str | None:
    """Return how a constant is written as a value of this kind."""
    text = other.value if isinstance(other, nodes.String) else format_term(other)
    if value.options and len(value.options) <= _MOST_OPTIONS:
        return did_you_mean(value.options)
    if value.kind == "string":
        return did_you_mean([f'"{text}"'])
    is_term = value.kind == "atom" and isinstance(other, nodes.String) and _TERM.fullmatch(str(text))
    return did_you_mean([str(text)]) if is_term else None


def _unit_of(number: float, value: Value) -> str:
    """Return the unit that a number is in, if it certainly is not in that of the value."""
    match value.unit:
        case "percent" if value.whole and 0 < number < 1:
            return "0 to 1"
        case "0 to 1" if number > 1:
            return "percent"
        case "radians" | "radians per second" if abs(number) >= _TURN:
            return value.unit.replace("radians", "degrees")
        case "degrees" if not float(number).is_integer() and _is_part_of_pi(number):
            return "radians"
    return ""


def _is_part_of_pi(number: float) -> bool:
    eighths = number / (pi / 4)
    return round(eighths) != 0 and abs(eighths - round(eighths)) < 0.005


def _named(unit: str) -> str:
    return "the range 0 to 1" if unit == "0 to 1" else unit


def mixed_units(
    flow: ProgramFlow, adders: Mapping[str, Sequence[Adder]], parameters: Mapping[Key, Sequence[str]]
) -> Iterator[Diagnostic]:
    """Return warnings about values that are passed to an operation in another unit than it expects.

    Args:
        flow: a program.
        adders: all that can give its agent beliefs, by name.
        parameters: the units of the parameters of operations; empty ones are not known.
    """
    for clause, action in flow.actions:
        wanted = parameters.get(key_of(action), ())
        variables = variables_of(clause, adders) if any(wanted) else {}
        for argument, unit in zip(action.arguments, wanted, strict=False):
            value, help = value_of(argument, variables), "convert it: `{0} * {1:.6g}`"
            if isinstance(argument, nodes.Number):
                value, help = Value(unit=_unit_of(argument.value, Value(unit=unit))), "write `{2:.6g}`"
            if value.unit != unit and {value.unit, unit} <= _FACTORS.keys() and _alike(value.unit, unit):
                name, factor = format_term(argument), _factor(value.unit, unit)
                number = argument.value * factor if isinstance(argument, nodes.Number) else 0
                message = (
                    f"`{name}` is in {_named(value.unit)}, but `{action.functor}` expects {_named(unit)}"
                )
                yield problem(UNIT, message, argument.span, help.format(name, factor, number))


def _alike(unit: str, other: str) -> bool:
    """Return whether two units measure the same."""
    return _FACTORS[unit][0] == _FACTORS[other][0]


def _factor(unit: str, wanted: str) -> float:
    return _FACTORS[unit][1] / _FACTORS[wanted][1]
