"""Check internal actions: names, numbers of arguments, and where they are used.

>>> from jacaros.agents.language.loader import load_program
>>> program, _ = load_program("robot.asl", "+!go <- .prnt(hi).")
>>> known = KnownActions({".print": Declaration()})
>>> [(each.message, each.help) for each in unknown_actions(program, ByKind(program.plans), known)]
[('unknown internal action `.prnt`', 'did you mean `.print`?')]
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Final

from jacaros.agents.checks.formulas import CONDITIONED, conditions
from jacaros.agents.language import nodes
from jacaros.agents.language.cursor import MOST_ASKED, is_slip_of
from jacaros.agents.language.diagnostics import Diagnostic, problem
from jacaros.agents.language.nodes import UNDECLARED, ByKind, Declaration, parts_of
from jacaros.agents.language.term_parser import PERFORMATIVES
from jacaros.agents.terms.functions import ARITIES
from jacaros.files.texts import did_you_mean, suggestion


def _no_hint(_: str) -> str | None:
    return None


@dataclass(frozen=True)
class KnownActions:
    """The internal actions that a program may use.

    Attributes:
        declared: by name; those of the language have a leading dot.
        help: suggested fix for an unknown name, if there is one.
        is_unseen: whether a name may become known when the project's Python code runs.
    """

    declared: Mapping[str, Declaration]
    help: Callable[[str], str | None] = _no_hint
    is_unseen: Callable[[str], bool] = lambda _: False

    def of(self, call: nodes.InternalAction) -> Declaration:
        """Return the declaration of the called action."""
        return self.declared.get(call.name, UNDECLARED)


def unknown_actions(program: nodes.Program, found: ByKind, known: KnownActions) -> Iterator[Diagnostic]:
    """Warn of unknown internal actions."""
    own = {name for function in program.functions for name in (function.implementation, function.name)}
    hints: dict[str, str | None] = {}
    for node in found.of(nodes.InternalAction):
        name = node.name
        if name in known.declared or name in own:
            continue
        if name in ARITIES:
            least, most = ARITIES[name]
            yield _arguments_message(node, least, None if most == float("inf") else int(most), "function")
            continue
        is_atom = not name.startswith(".") and not node.arguments  # such as the name of a class
        if is_atom or known.is_unseen(name):
            continue
        if name not in hints:
            meant = known.help(name) or suggestion(name, known.declared) if len(hints) < MOST_ASKED else None
            hints[name] = meant or None
        yield problem("unknown-internal-action", f"unknown internal action `{name}`", node.span, hints[name])


def wrong_arguments(found: ByKind, known: KnownActions) -> Iterator[Diagnostic]:
    """Warn of internal actions with too few or too many arguments."""
    for node in found.of(nodes.InternalAction):
        action = known.declared.get(node.name)
        count = len(node.arguments)
        if action is not None and not action.takes(count):
            wrong = _arguments_message(node, action.minimum, action.maximum, "internal action")
            if action.maximum is not None and count == action.maximum + 1 and action.result_hint:
                wrong = replace(wrong, help=action.result_hint)
            yield wrong


def _arguments_message(node: nodes.InternalAction, least: int, most: int | None, what: str) -> Diagnostic:
    if most is None:
        wanted = f"at least {_arguments(least)}"
    elif least == most:
        wanted = _arguments(least)
    else:
        wanted = f"{least} to {most} arguments"
    return problem(
        "wrong-arguments",
        f"{what} `{node.name}` expects {wanted}, found {len(node.arguments) or 'none'}",
        node.span,
    )


def _arguments(count: int) -> str:
    return f"{count or 'no'} argument{'' if count == 1 else 's'}"


def acting_conditions(found: ByKind, known: KnownActions) -> Iterator[Diagnostic]:
    """Warn of internal actions that act or wait and are used as conditions."""
    for node in found.of(*CONDITIONED):
        for formula in conditions(node):
            for part in parts_of(formula):
                if isinstance(part, nodes.InternalAction) and known.of(part).suspends:
                    message = f"`{part.name}` acts or takes time and never holds as a condition"
                    yield problem("acting-condition", message, part.span, "make it a step of the body")


_PRINTING: Final = frozenset({".print", ".println", ".printf"})
_SHORT: Final = 10
"""Milliseconds: a shorter `.wait` was probably meant in seconds."""


def doubtful_values(found: ByKind) -> Iterator[Diagnostic]:
    """Note waits that are probably meant in seconds, and atoms that are probably meant as texts."""
    for node in found.of(nodes.InternalAction):
        first = node.arguments[0] if node.arguments else None
        if node.name == ".wait" and isinstance(first, nodes.Number) and 0 < first.value < _SHORT:
            time = f"{first.value:g}"
            help = f"for {time} s write `.wait({first.value * 1000:g})`"
            yield problem("short-wait", f"`.wait({time})` waits for {time} ms", first.span, help)
        for word in node.arguments if node.name in _PRINTING else ():
            if isinstance(word, nodes.Literal) and word.functor.startswith("'") and not word.arguments:
                text = word.functor.strip("'")
                message = f"`{word.functor}` is an atom, which is printed with its quotes"
                yield problem("quoted-atom", message, word.span, f'write a text as `"{text}"`')


def unknown_performatives(found: ByKind, known: KnownActions) -> Iterator[Diagnostic]:
    """Warn of misspelt performatives; a word that is not similar to one may be the program's own."""
    for node in found.of(nodes.InternalAction):
        place = known.of(node).performative
        if place is None or len(node.arguments) <= place:
            continue
        word = node.arguments[place]
        if not isinstance(word, nodes.Literal) or word.arguments or word.functor in PERFORMATIVES:
            continue
        meant = [each for each in PERFORMATIVES if is_slip_of(word.functor.lower(), each.lower())]
        meant += [each for each in PERFORMATIVES if word.functor.lower() == each.lower()]
        if meant:
            yield problem(
                "unknown-performative",
                f"unknown performative `{word.functor}`",
                word.span,
                did_you_mean(meant[:1]),
            )
