"""Terms of the language ↔ plain values of the environment.

=========================  ==========================================================================
term                       plain value
=========================  ==========================================================================
number                     `int` when it is whole, else `float`
string                     `str`
``true``, ``false``        `bool`
atom                       `Atom`, without the quotes of a quoted one
structure                  `Structure`; ``~`` and a namespace are written in front of the functor
list, set, queue           `list`, that of a set in the standard order
map                        `dict`; lists in its keys are tuples
annotated structure        `Structure` with its annotations; other annotated terms lose theirs
opaque reference           the object
unbound variable           `Out`, one for each occurrence; from the environment None comes as a fresh variable
formula, plan              its text
=========================  ==========================================================================
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Final
from weakref import WeakValueDictionary

from jacaros.agents.mind.state.act import Percept
from jacaros.agents.terms.collections import MapValue, QueueValue, SetValue
from jacaros.agents.terms.operators import WORDS
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import (
    ARITHMETIC,
    CONS,
    FALSE,
    FUNCTION,
    NIL,
    PLAIN,
    SOURCE_PERCEPT,
    TRUE,
    Annotated,
    Annotations,
    Functor,
    List,
    Reference,
    String,
    Term,
    Var,
    atom,
    deref,
    functor,
    make_list,
    number,
    parted,
)
from jacaros.artifacts.env.errors import ArtifactId
from jacaros.artifacts.env.ports import Workspace
from jacaros.artifacts.env.property import ObservableProperty, Observation
from jacaros.artifacts.env.values import Atom, Out, Structure, plain
from jacaros.runtime.trace import Cause

Outputs = list[tuple[Var, Out]]
"""Unbound variables of an action, with the places for the values of an operation."""

_CARRIED_AS_STRUCTURES = (PLAIN, ARITHMETIC, FUNCTION)


def to_value(term: Term, outputs: Outputs | None = None) -> Any:
    """Convert a term, with its bindings applied, to a plain value.

    Args:
        outputs: receives the unbound variables of the term, each occurrence with its `Out`.
    """
    kind = term.__class__
    if kind is float:
        return int(term) if term.is_integer() else term
    if kind is int:
        return term
    if kind is String:
        return str(term)
    if kind is Var:
        return _variable_to_value(term, outputs)
    if kind is Functor:
        return _atom_to_value(term)
    if kind is List:
        return [to_value(item, outputs) for item in term.elements()]
    if kind is tuple:
        return _structure_to_value(term, outputs)
    if kind is Annotated:
        return _annotated_to_value(term, outputs)
    return _object_to_value(term, outputs)


def _variable_to_value(variable: Var, outputs: Outputs | None) -> Any:
    bound = deref(variable)
    if bound.__class__ is not Var:
        return to_value(bound, outputs)
    out = Out(bound)
    if outputs is not None:
        outputs.append((bound, out))
    return out


def _atom_to_value(symbol: Functor) -> object:
    if symbol is NIL:
        return []
    if symbol is TRUE or symbol is FALSE:
        return symbol is TRUE
    return Atom(symbol_name(symbol))


def _structure_to_value(term: Term, outputs: Outputs | None) -> object:
    symbol = term[0]
    if symbol is CONS:
        return [to_value(item, outputs) for item in parted(term)[0]]
    if symbol.kind not in _CARRIED_AS_STRUCTURES:
        return text(term)
    return Structure(symbol_name(symbol), tuple(to_value(argument, outputs) for argument in term[1:]))


def _annotated_to_value(term: Annotated, outputs: Outputs | None) -> object:
    value = to_value(term.term, outputs)
    if value.__class__ is not Structure:
        return value
    annotations = tuple(to_value(each, outputs) for each in term.annotations)
    return Structure(value.functor, value.arguments, annotations)


def _object_to_value(term: Term, outputs: Outputs | None) -> object:
    if term.__class__ is Reference:
        return term.value
    if isinstance(term, MapValue):
        return {_key(to_value(key)): to_value(value, outputs) for key, value in term.items.items()}
    if isinstance(term, (SetValue, QueueValue)):
        return [to_value(item, outputs) for item in term]
    return term


def _key(value: object) -> object:
    """Return a hashable key: lists become tuples, maps tuples of pairs."""
    if isinstance(value, list):
        return tuple(map(_key, value))
    if isinstance(value, dict):
        return tuple((key, _key(item)) for key, item in value.items())
    if isinstance(value, Structure):
        return Structure(value.functor, tuple(map(_key, value.arguments)))
    return value


def symbol_name(symbol: Functor) -> str:
    """Return the name of a functor in the environment's form: no quotes; ``~`` and the namespace in front."""
    name = unquoted(symbol.name)
    if symbol.negated:
        name = f"~{name}"
    return f"{symbol.namespace}::{name}" if symbol.namespace else name


def unquoted(name: str) -> str:
    """Return the name of a functor without quotes."""
    return name[1:-1] if name[:1] == "'" and name[-1:] == "'" and len(name) > 1 else name


_references: WeakValueDictionary[int, Reference] = WeakValueDictionary()
"""The references in use, by the identity of their objects, which live as long as they do."""


def reference_to(value: object) -> Reference:
    """Return the reference to *value*: the same one while it is in use, and with the same text (``cobj_N``)."""
    known = _references.get(id(value))
    if known is None:
        known = _references[id(value)] = Reference(value)
    return known


class References:
    """Keeps the references to artifacts and workspaces, so that they have the same text in the whole run.

    Other objects are not kept: that would keep every image of a camera alive.
    """

    def __init__(self) -> None:
        self._kept: dict[int, Reference] = {}

    def of(self, value: object) -> Reference:
        """Return the only reference to *value*, which is kept alive from now on."""
        known = self._kept.get(id(value))
        if known is None:
            known = self._kept[id(value)] = reference_to(value)
        return known

    def forget(self, value: object) -> None:
        """Release *value*, which will not be named again, such as the id of a disposed artifact."""
        self._kept.pop(id(value), None)


class _Unkept(References):
    def of(self, value: object) -> Reference:
        return reference_to(value)


UNKEPT: Final = _Unkept()
"""For values of Python code: nothing is kept alive, and kept objects have the same text as in the run."""


def to_term(value: Any, references: References) -> Term:
    """Convert a plain value, or a value that `jacaros.artifacts.env.values.plain` accepts, to a term."""
    convert = _BY_CLASS.get(value.__class__)
    if convert is not None:
        return convert(value, references)
    return _other_to_term(value, references)


@lru_cache(4096)
def symbol_of(name: str, arity: int) -> Functor:
    """Return the functor for a name from the environment, quoted unless it is a plain lower-case word."""
    namespace, separator, rest = name.rpartition("::")
    if separator and _is_word(namespace) and rest:
        name = rest
    else:
        namespace = ""
    negated = name[:1] == "~" and len(name) > 1
    name = name[1:] if negated else name
    # The name of a functor is a plain str, whatever class of text named it first.
    return functor(str(name) if _is_word(name) else f"'{name}'", arity, negated, namespace or None)


def atom_of(name: str) -> Functor:
    """Return the atom for the name of an artifact or workspace: always an atom, quoted if necessary."""
    return atom(str(name) if _is_word(name) else f"'{name}'")


def _is_word(name: str) -> bool:
    return name.isidentifier() and name[0].islower() and name not in WORDS


def _structure_to_term(value: Structure, references: References) -> Term:
    arguments = value.arguments
    term: Term = symbol_of(value.functor, len(arguments))
    if arguments:
        term = (term, *[to_term(argument, references) for argument in arguments])
    if value.annotations:
        return Annotated(term, annotation_set(tuple(to_term(each, references) for each in value.annotations)))
    return term


def _list_to_term(value: list[object], references: References) -> Term:
    return make_list([to_term(item, references) for item in value])


def _dict_to_term(value: dict[object, object], references: References) -> Term:
    return MapValue({to_term(key, references): to_term(item, references) for key, item in value.items()})


def _set_to_term(value: frozenset[object], references: References) -> Term:
    return SetValue({to_term(item, references): None for item in value})


def _other_to_term(value: Any, references: References) -> Term:
    simple = plain(value)
    if simple.__class__ in _BY_CLASS:
        return to_term(simple, references)
    if isinstance(simple, Out):
        return to_term(simple.value, references) if simple.is_set else Var()
    return reference_to(simple)


_BY_CLASS: dict[type, Callable[[Any, References], Term]] = {
    float: lambda value, _: value,
    int: lambda value, _: number(value),
    bool: lambda value, _: TRUE if value else FALSE,
    str: lambda value, _: String(value),
    Atom: lambda value, _: TRUE if value == "true" else FALSE if value == "false" else symbol_of(value, 0),
    Structure: _structure_to_term,
    list: _list_to_term,
    tuple: _list_to_term,
    dict: _dict_to_term,
    frozenset: _set_to_term,
    type(None): lambda value, _: Var(),
    ArtifactId: lambda value, references: references.of(value),
}


# From observations of focused artifacts to percepts of the mind.

ADD, REMOVE, SIGNAL = "add", "remove", "signal"

_ARTIFACT_ID = functor("artifact_id", 1)
_ARTIFACT_NAME = functor("artifact_name", 1)
_MEMBER = functor("member", 1)
_PERCEPT_TYPE = functor("percept_type", 1)
_WORKSPACE = functor("workspace", 2)
_OBSERVABLE_PROPERTY = (_PERCEPT_TYPE, atom("obs_prop"))
_OBSERVABLE_EVENT = (_PERCEPT_TYPE, atom("obs_ev"))
_NULL = Atom("null")


class PerceptWriter:
    """Writes observations as percepts, with the annotations of their origin.

    ``count(1)[artifact_id(cobj_1), artifact_name(c), percept_type(obs_prop), source(percept), workspace("/main",
    cobj_2)]``, as in the bridge between CArtAgO and Jason, but the name of the artifact is always an atom. An artifact of
    another member of a fleet has ``member(Name)``, too.

    Args:
        references: shared by all agents of a run.
        workspace: returns the object of a workspace, given its full path.

    Attributes:
        newest, namespace, written: the last observation, its namespace and its percepts; the next request usually
            comes from another observer of the same observation.
    """

    def __init__(self, references: References, workspace: Callable[[str], Workspace]) -> None:
        self.references = references
        self._workspace = workspace
        self.newest: Observation | None = None
        self.namespace: str | None = None
        self.written: list[Percept] = []
        self._annotations: dict[ArtifactId, tuple[tuple[Term, ...], tuple[Term, ...]]] = {}

    def percepts(self, observation: Observation, namespace: str | None = None) -> list[Percept]:
        """Return the percepts of one observation, in the order for the mind.

        Signals come first, then for each changed property the end of the old and the beginning of the new value, then
        new properties, then removed ones.

        The list is shared: it must not be changed.

        Args:
            namespace: namespace of the agent's program in which the artifact was focused (``ns::focus``).
        """
        if observation is self.newest and namespace == self.namespace:
            return self.written
        artifact, signals, changed, added, removed, cause = observation
        about_property, about_signal = self._annotations.get(artifact) or self._origin(artifact)
        found: list[Percept] = []
        for signal in signals:
            literal, _ = self._literal(signal.name, signal.arguments, namespace)
            found.append(Percept(SIGNAL, literal, about_signal, cause))
        for old, new in changed:
            first: Percept | None = old.written
            if first is None or namespace:
                found.append(self._percept(REMOVE, old, about_property, namespace, cause))
            else:  # the usual case
                found.append(Percept(REMOVE, first.literal, first.annotations, cause, first.kept))
            found.append(self._percept(ADD, new, about_property, namespace, cause))
        for each in added:
            found.append(self._percept(ADD, each, about_property, namespace, cause))
        for each in removed:
            found.append(self._percept(REMOVE, each, about_property, namespace, cause))
        self.newest, self.namespace, self.written = observation, namespace, found
        return found

    def _percept(
        self,
        kind: str,
        each: ObservableProperty,
        about: Annotations,
        namespace: str | None,
        cause: Cause | None,
    ) -> Percept:
        """Return a percept of a property. The first one is stored with it, for its end and for all other observers."""
        first: Percept | None = each.written
        if first is None:
            if each.annotations:
                own = tuple(to_term(a, self.references) for a in each.annotations)
                about = annotation_set((*about, *own))
            literal, kept = self._literal(each.name, each.values, None)
            first = each.written = Percept(kind, literal, about, cause, kept)
            if not namespace:
                return first
        if not namespace:
            return Percept(kind, first.literal, first.annotations, cause, first.kept)
        # The identical arguments: the mind uses them to find the belief to remove.
        symbol = symbol_of(f"{namespace}::{each.name}", len(each.values))
        literal = (symbol, *first.literal[1:]) if each.values else symbol
        return Percept(kind, literal, first.annotations, cause)

    def own(self, kind: str, about: ArtifactId, name: str, *arguments: Term) -> Percept:
        """Return a percept about the agent itself, such as ``joinedWsp(Id,lab,"/main/lab")``.

        Args:
            kind: `ADD` or `REMOVE`.
            about: the artifact whose property it is, the agent's body or session.
            name: its functor.
            arguments: ground terms.
        """
        return Percept(kind, (functor(name, len(arguments)), *arguments), self._origin(about)[0])

    def forget(self, artifact: ArtifactId) -> None:
        """Forget an artifact that will not be observed again soon."""
        self._annotations.pop(artifact, None)

    def _origin(self, artifact: ArtifactId) -> tuple[tuple[Term, ...], tuple[Term, ...]]:
        """Return the annotations of properties and of signals of an artifact."""
        known = self._annotations.get(artifact)
        if known is None:
            holder = self._workspace(artifact.workspace)
            workspace, member = self.references.of(holder), holder.member
            identity = (_ARTIFACT_ID, self.references.of(artifact))
            name = (_ARTIFACT_NAME, atom_of(artifact.name))
            place = (_WORKSPACE, String(artifact.workspace), workspace)
            origin = (identity, name, (_MEMBER, atom_of(member))) if member else (identity, name)
            # In the canonical order of annotations: this code runs for every agent.
            known = self._annotations[artifact] = (
                (*origin, _OBSERVABLE_PROPERTY, SOURCE_PERCEPT, place),
                (*origin, _OBSERVABLE_EVENT, SOURCE_PERCEPT, place),
            )
        return known

    def _literal(self, name: str, values: tuple[object, ...], namespace: str | None) -> tuple[Term, Any]:
        """Return a literal, and its parts for the mind if all arguments are numbers (`Percept.kept`)."""
        symbol = symbol_of(f"{namespace}::{name}" if namespace else name, len(values))
        if not values:
            return symbol, (symbol, (), True)
        written: list[Term] = []
        numbers = True
        for value in values:
            # Nearly all are numbers.
            kind = type(value)
            if kind is float:
                written.append(value)
            elif kind is int:
                written.append(number(value))  # type: ignore[arg-type]
            else:
                written.append(to_term(_complete(value), self.references))
                numbers = False
        return (symbol, *written), (symbol, tuple(written), True) if numbers else None


def _complete(value: object) -> object:
    """Make a percept ground: None and unset outputs become the atom ``null``."""
    kind = type(value)
    if kind is list:
        return [each if type(each) is float else _complete(each) for each in value]  # type: ignore[attr-defined]
    if kind is dict:
        return {_complete(key): _complete(each) for key, each in value.items()}  # type: ignore[attr-defined]
    if isinstance(value, (tuple, frozenset)):
        return kind(map(_complete, value))  # type: ignore[call-arg]
    if isinstance(value, Structure):
        return Structure(value.functor, tuple(map(_complete, value.arguments)))
    if isinstance(value, Out):
        return _complete(value.value) if value.is_set else _NULL
    return _NULL if value is None else value


Notice = Callable[[list[Percept]], None]
"""Receives percepts."""

Untaken = Callable[[str], bool]
"""Returns whether percepts about properties of a name are still unprocessed."""


@dataclass(slots=True, eq=False, repr=False)
class FocusObserver:
    """Perceives for an agent, in one namespace of its program.

    Attributes:
        agent: name of the agent.
        namespace: namespace of its program.
        writer: writes its percepts.
        notice: receives its percepts.
        has_untaken: returns whether the mind still has unprocessed percepts about properties of a name.
    """

    agent: str
    namespace: str | None
    writer: PerceptWriter
    notice: Notice
    has_untaken: Untaken

    def observe(self, observation: Observation) -> None:
        """Pass an observation to the mind."""
        writer, namespace = self.writer, self.namespace
        # The percepts just written for another observer are the same.
        if observation is writer.newest and namespace is writer.namespace:
            self.notice(writer.written)
        else:
            self.notice(writer.percepts(observation, namespace))
