"""Terms and plain values as data of msgpack, and back.

Numbers, strings, Booleans and None stand for themselves. Everything else is a list that begins with its kind:

=======================  =============================================
``[0, name]``            atom
``[1, name, args...]``   structure
``[2, items...]``        list
``[3, term, ann...]``    annotated term
``[4, number]``          variable, or output parameter
``[5, key, value...]``   map
``[6, items...]``        set
``[7, prio, items...]``  queue
``[8, run, n, ...]``     artifact: run of a member, number, name, type, workspace
``[9, digits]``          integer of more than 64 bits
``[10, items...]``       tuple, as a key
=======================  =============================================

A name is a string, or ``[name, negated, namespace, kind]``.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

from jacaros.agents.terms.collections import MapValue, QueueValue, SetValue
from jacaros.agents.terms.substitution import resolve
from jacaros.agents.terms.values import (
    PLAIN,
    Annotated,
    Functor,
    List,
    Reference,
    String,
    Term,
    Var,
    functor,
    listed,
)
from jacaros.artifacts.env.errors import ArtifactId
from jacaros.artifacts.env.values import Atom, Out, Structure

ATOM, STRUCTURE, LIST, ANNOTATED, VARIABLE, MAP, SET, QUEUE, ARTIFACT, BIG, TUPLE = range(11)
_SMALL: Final = 1 << 63

ArtifactName = tuple[str, int, str, str, str]
"""How members call an artifact: the run of the member that has it, its number there, its name, type and workspace."""


class NotSendable(Exception):
    """A value that cannot leave its process. The text names it, and says what to do."""

    def __init__(self, value: object) -> None:
        self.value = value
        kind = type(value).__name__
        super().__init__(
            f"a value of the class {kind} cannot be sent to another system: send its parts (numbers, strings, atoms, "
            "structures, lists, maps)"
        )


class Wire:
    """Converts for one pair of members.

    Args:
        name: returns how an artifact is called.
        find: returns the artifact that is called so.
    """

    def __init__(
        self, name: Callable[[ArtifactId], ArtifactName], find: Callable[[ArtifactName], ArtifactId]
    ) -> None:
        self._name, self._find = name, find

    # ---- terms

    def from_term(self, term: Term) -> Any:
        """Return a term as data.

        Raises:
            NotSendable: it contains an object of Python.
        """
        return self._term(resolve(term), {})

    def _term(self, term: Term, variables: dict[Var, int]) -> Any:
        kind = term.__class__
        if kind is float:
            return term
        if kind is String:
            return str.__str__(term)
        if kind is Functor:
            return [ATOM, _name_of(term)]
        if kind is tuple:
            return [STRUCTURE, _name_of(term[0]), *(self._term(each, variables) for each in term[1:])]
        if kind is List:
            return [LIST, *(self._term(each, variables) for each in term.elements())]
        return self._other_term(term, variables)

    def _other_term(self, term: Term, variables: dict[Var, int]) -> Any:
        kind = term.__class__
        if kind is int:
            return [BIG, str(term)]
        if kind is Var:
            return [VARIABLE, variables.setdefault(term, len(variables))]
        if kind is Annotated:
            annotations = (self._term(each, variables) for each in term.annotations)
            return [ANNOTATED, self._term(term.term, variables), *annotations]
        if kind is MapValue:
            pairs = (each for pair in term.items.items() for each in pair)
            return [MAP, *(self._term(each, variables) for each in pairs)]
        if kind is SetValue:
            return [SET, *(self._term(each, variables) for each in term)]
        if kind is QueueValue:
            return [QUEUE, term.priority, *(self._term(each, variables) for each in term)]
        if kind is Reference and isinstance(term.value, ArtifactId):
            return [ARTIFACT, *self._name(term.value)]
        raise NotSendable(term.value if kind is Reference else term)

    def to_term(self, data: Any) -> Term:
        """Return data as a term.

        Raises:
            ValueError: it is not a term.
        """
        return self._to_term(data, {})

    def _to_term(self, data: Any, variables: dict[int, Var]) -> Term:
        kind = data.__class__
        if kind is float:
            return data
        if kind is str:
            return String(data)
        if kind is not list or not data:
            raise ValueError(f"no term: {data!r}")
        what, rest = data[0], data[1:]
        if what == ATOM:
            return _symbol(rest[0], 0)
        if what == STRUCTURE:
            arguments = [self._to_term(each, variables) for each in rest[1:]]
            return (_symbol(rest[0], len(arguments)), *arguments)
        if what == LIST:
            return listed(*(self._to_term(each, variables) for each in rest))
        return self._to_other_term(what, rest, variables)

    def _to_other_term(self, what: int, rest: list[Any], variables: dict[int, Var]) -> Term:
        if what == BIG:
            return int(rest[0])
        if what == VARIABLE:
            return variables.setdefault(rest[0], Var())
        if what == ARTIFACT:
            return Reference(self._found(rest))
        parts = [self._to_term(each, variables) for each in rest[what == QUEUE :]]
        if what == ANNOTATED:
            return Annotated(parts[0], tuple(parts[1:]))
        if what == MAP:
            return MapValue(dict(zip(parts[::2], parts[1::2], strict=True)))
        if what == SET:
            return SetValue(dict.fromkeys(parts))
        if what == QUEUE:
            return QueueValue(bool(rest[0]), parts)
        raise ValueError(f"no term: kind {what!r}")

    def _found(self, rest: Sequence[Any]) -> ArtifactId:
        run, number, name, type_name, workspace = rest
        if not isinstance(number, int):
            raise ValueError(f"no artifact: {rest!r}")
        return self._find((str(run), number, str(name), str(type_name), str(workspace)))

    # ---- plain values

    def from_value(self, value: object, outs: list[Out] | None = None) -> Any:
        """Return a plain value as data.

        Args:
            value: the value.
            outs: collects output parameters. None: they are sent as unset.

        Raises:
            NotSendable: it contains an opaque object.
        """
        kind = value.__class__
        if kind is float or kind is str or kind is bool or value is None:
            return value
        if kind is int:
            return value if -_SMALL <= value < _SMALL else [BIG, str(value)]  # type: ignore[operator]
        if isinstance(value, Atom):
            return [ATOM, str.__str__(value)]
        if isinstance(value, Structure):
            arguments = [STRUCTURE, value.functor, *(self.from_value(each, outs) for each in value.arguments)]
            if not value.annotations:
                return arguments
            return [ANNOTATED, arguments, *(self.from_value(each, outs) for each in value.annotations)]
        if isinstance(value, (list, tuple)):
            return [LIST if kind is list else TUPLE, *(self.from_value(each, outs) for each in value)]
        return self._from_other_value(value, outs)

    def _from_other_value(self, value: object, outs: list[Out] | None) -> Any:
        if isinstance(value, Mapping):
            return [MAP, *(self.from_value(each, outs) for pair in value.items() for each in pair)]
        if isinstance(value, frozenset):
            return [SET, *(self.from_value(each, outs) for each in value)]
        if isinstance(value, ArtifactId):
            return [ARTIFACT, *self._name(value)]
        if isinstance(value, Out):
            if outs is None:
                return None
            if not any(each is value for each in outs):
                outs.append(value)
            return [VARIABLE, next(place for place, each in enumerate(outs) if each is value)]
        raise NotSendable(value)

    def to_value(self, data: Any, outs: list[Out] | None = None) -> Any:
        """Return data as a plain value.

        Args:
            data: what `from_value` returned.
            outs: collects output parameters.

        Raises:
            ValueError: it is not a value.
        """
        if data.__class__ is not list:
            return data
        what, rest = data[0], data[1:]
        if what == ATOM:
            return Atom(rest[0])
        if what == BIG:
            return int(rest[0])
        if what == ARTIFACT:
            return self._found(rest)
        if what == VARIABLE:
            return _out(rest[0], outs)
        name = str(rest.pop(0)) if what == STRUCTURE else ""
        parts = [self.to_value(each, outs) for each in rest]
        if what == LIST:
            return parts
        if what == STRUCTURE:
            return Structure(name, tuple(parts))
        if what == ANNOTATED:
            return Structure(parts[0].functor, parts[0].arguments, tuple(parts[1:]))
        if what == MAP:
            return dict(zip(parts[::2], parts[1::2], strict=True))
        if what in (SET, TUPLE):
            return frozenset(parts) if what == SET else tuple(parts)
        raise ValueError(f"no value: kind {what!r}")


def _out(place: int, outs: list[Out] | None) -> Out:
    if outs is None or not 0 <= place <= len(outs):
        raise ValueError(f"no output parameter {place!r}")
    if place == len(outs):
        outs.append(Out())
    return outs[place]


def _name_of(symbol: Functor) -> Any:
    if symbol.kind == PLAIN and not symbol.negated and symbol.namespace is None:
        return symbol.name
    return [symbol.name, symbol.negated, symbol.namespace, symbol.kind]


def _symbol(name: Any, arity: int) -> Functor:
    if name.__class__ is str:
        return functor(name, arity)
    written, negated, namespace, kind = name
    if not isinstance(written, str) or not isinstance(kind, int) or kind not in range(8):
        raise ValueError(f"no name: {name!r}")
    return functor(written, arity, bool(negated), namespace, kind)
