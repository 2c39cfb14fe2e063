"""Internal actions: their names, numbers of arguments, and where they stand."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final, Protocol

from jacaros.asl import nodes
from jacaros.asl.checks.formulas import conditions, parts_of
from jacaros.asl.diagnostics import Diagnostic
from jacaros.asl.functions import ARITIES
from jacaros.asl.spelling import MOST_ASKED, close_matches, is_slip_of

_PERFORMATIVES: Final = (
    *("tell", "untell", "achieve", "unachieve", "askOne", "askAll", "askHow"),
    *("tellHow", "untellHow", "signal"),
)


class Signature(Protocol):
    """What is to be known of an internal action; ``maximum`` is None for any number of arguments."""

    @property
    def minimum(self) -> int:
        """The least number of arguments."""

    @property
    def maximum(self) -> int | None:
        """The greatest number of arguments."""

    @property
    def result_hint(self) -> str:
        """How its author gives it one argument more, for a result; empty when that is not the mistake."""

    @property
    def suspends(self) -> bool:
        """Whether it acts or waits, so that it cannot be asked as a condition."""


def _no_hint(_: str) -> str | None:
    return None


@dataclass(frozen=True)
class KnownActions:
    """The internal actions that a program may use.

    Attributes:
        signatures: by name; those of the language have a leading dot.
        hint: what to do about a name that is not among them, as far as that is known.
        is_unseen: whether a name may be among them when the project's Python code runs.
    """

    signatures: Mapping[str, Signature]
    hint: Callable[[str], str | None] = _no_hint
    is_unseen: Callable[[str], bool] = lambda _: False


def unknown_actions(
    program: nodes.Program, found: Sequence[nodes.Node], known: KnownActions
) -> Iterator[Diagnostic]:
    """Internal actions that there are not."""
    functions = {function.implementation for function in program.functions}
    registered = {function.name for function in program.functions}
    hints: dict[str, str | None] = {}
    for node in found:
        if not isinstance(node, nodes.InternalAction):
            continue
        name = node.name
        if name in known.signatures or name in functions or name in registered:
            continue
        if name in ARITIES:
            yield _wrong_function(node)
            continue
        if known.is_unseen(name):
            continue
        if not name.startswith(".") and not node.arguments:
            # An atom with a dot, such as a class name.
            continue
        if name not in hints:
            hints[name] = _meant_action(name, known) if len(hints) < MOST_ASKED else None
        yield Diagnostic(
            "warning",
            f"there is no internal action {name}",
            node.span,
            hints[name],
            "unknown-internal-action",
        )


def _meant_action(name: str, known: KnownActions) -> str | None:
    close = close_matches(name, known.signatures)
    return known.hint(name) or (f"did you mean {close[0]}?" if close else None)


def _wrong_function(node: nodes.InternalAction) -> Diagnostic:
    least, most = ARITIES[node.name]
    return _arguments_message(node, least, None if most == float("inf") else int(most), "the function")


def wrong_arguments(found: Sequence[nodes.Node], known: KnownActions) -> Iterator[Diagnostic]:
    """Internal actions with too few or too many arguments."""
    for node in found:
        if isinstance(node, nodes.InternalAction):
            signature = known.signatures.get(node.name)
            count = len(node.arguments)
            if signature is not None and not (
                signature.minimum <= count and (signature.maximum is None or count <= signature.maximum)
            ):
                told = _arguments_message(node, signature.minimum, signature.maximum, "the internal action")
                if signature.maximum is not None and count == signature.maximum + 1 and signature.result_hint:
                    told = replace(told, hint=f"{told.hint}; {signature.result_hint}")
                yield told


def _arguments_message(node: nodes.InternalAction, least: int, most: int | None, what: str) -> Diagnostic:
    if most is None:
        wanted = f"at least {_arguments(least)}"
    elif least == most:
        wanted = _arguments(least)
    else:
        wanted = f"{least} to {most} arguments"
    return Diagnostic(
        "warning",
        f"{what} {node.name} cannot have {_arguments(len(node.arguments))}",
        node.span,
        f"it takes {wanted}",
        "wrong-arguments",
    )


def _arguments(count: int) -> str:
    return f"{count or 'no'} argument{'' if count == 1 else 's'}"


def acting_conditions(found: Sequence[nodes.Node], known: KnownActions) -> Iterator[Diagnostic]:
    """Internal actions that act or wait and are asked whether they hold."""
    for node in found:
        for formula in conditions(node):
            for part in parts_of(formula):
                if isinstance(part, nodes.InternalAction):
                    signature = known.signatures.get(part.name)
                    if signature is not None and signature.suspends:
                        yield Diagnostic(
                            "warning",
                            f"{part.name} acts or takes time and never holds as a condition",
                            part.span,
                            "make it a step of the body",
                            "acting-condition",
                        )


def unknown_performatives(found: Sequence[nodes.Node]) -> Iterator[Diagnostic]:
    """Performatives that are nearly those of the language; any other word may be one of the program's own."""
    places = {".send": 1, ".broadcast": 0}
    for node in found:
        place = places.get(node.name) if isinstance(node, nodes.InternalAction) else None
        if not isinstance(node, nodes.InternalAction) or place is None or len(node.arguments) <= place:
            continue
        word = node.arguments[place]
        if not isinstance(word, nodes.Literal) or word.arguments or word.functor in _PERFORMATIVES:
            continue
        meant = [each for each in _PERFORMATIVES if is_slip_of(word.functor.lower(), each.lower())]
        meant += [each for each in _PERFORMATIVES if word.functor.lower() == each.lower()]
        if meant:
            yield Diagnostic(
                "warning",
                f"there is no performative {word.functor}",
                word.span,
                f"did you mean {meant[0]}?",
                "unknown-performative",
            )
