"""From observations of focused artifacts to percepts of the mind."""

from collections.abc import Callable
from typing import Any

from jacaros.agents.body.values import References, atom_of, symbol_of, to_term
from jacaros.agents.mind.state.act import Percept
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.values import SOURCE_PERCEPT, String, Term, atom, functor, number
from jacaros.artifacts.env.errors import ArtifactId
from jacaros.artifacts.env.property import ObservableProperty, Observation
from jacaros.artifacts.env.values import Atom, Out, Structure
from jacaros.runtime.trace import Cause

ADD, REMOVE, SIGNAL = "add", "remove", "signal"

_ARTIFACT_ID = functor("artifact_id", 1)
_ARTIFACT_NAME = functor("artifact_name", 1)
_PERCEPT_TYPE = functor("percept_type", 1)
_WORKSPACE = functor("workspace", 2)
_OBSERVABLE_PROPERTY = (_PERCEPT_TYPE, atom("obs_prop"))
_OBSERVABLE_EVENT = (_PERCEPT_TYPE, atom("obs_ev"))
_NULL = Atom("null")

Annotations = tuple[Term, ...]


class PerceptWriter:
    """Writes observations as percepts, with the annotations of their origin.

    ``count(1)[artifact_id(cobj_1), artifact_name(c), percept_type(obs_prop), source(percept), workspace("/main",
    cobj_2)]``, as in the bridge between CArtAgO and Jason, but the name of the artifact is always an atom.

    Args:
        references: shared by all agents of a run.
        workspace: returns the object of a workspace, given its full path.

    Attributes:
        newest, namespace, written: the last observation, its namespace and its percepts; the next request usually
            comes from another observer of the same observation.
    """

    def __init__(self, references: References, workspace: Callable[[str], object]) -> None:
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
            workspace = self.references.of(self._workspace(artifact.workspace))
            identity = (_ARTIFACT_ID, self.references.of(artifact))
            name = (_ARTIFACT_NAME, atom_of(artifact.name))
            place = (_WORKSPACE, String(artifact.workspace), workspace)
            # In the canonical order of annotations: this code runs for every agent.
            known = self._annotations[artifact] = (
                (identity, name, _OBSERVABLE_PROPERTY, SOURCE_PERCEPT, place),
                (identity, name, _OBSERVABLE_EVENT, SOURCE_PERCEPT, place),
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
