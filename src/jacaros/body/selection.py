"""Which artifact carries out an action: the rules of CArtAgO's bridge to Jason.

An annotation of the action directs it: ``artifact_id`` (``aid``) before ``artifact_name`` (``art``), inside
the workspace given by ``wid`` or ``wsp``.  A namespace in front of the action means the artifacts focused in
that namespace first.  Otherwise the workspaces are gone through: the current one of the intention, the
agent's home, then the others that it has joined (see `jacaros.env.choice` for several candidates in one).
"""

import difflib
from collections.abc import Sequence

from jacaros.bdi.actions.internal_action import STANDARD
from jacaros.body.call import ANYWHERE, Call
from jacaros.body.focus import FocusedArtifacts
from jacaros.body.undelivered import nobody_offers, unreachable
from jacaros.body.whereabouts import Whereabouts, not_joined
from jacaros.env.choice import artifact_named, chosen_artifact
from jacaros.env.default.furnishing import DEFAULT_TYPES
from jacaros.env.errors import OperationFailed, UnknownArtifact
from jacaros.env.ids import ArtifactId, resolve_path
from jacaros.env.ports import Workspace


class Selection:
    """Selects artifacts for one agent.

    Args:
        agent: name of the agent.
        whereabouts: its workspaces.
        focused: its focused artifacts.
        own_actions: names with numbers of arguments of what its body does without any artifact, for hints.
    """

    def __init__(
        self,
        agent: str,
        whereabouts: Whereabouts,
        focused: FocusedArtifacts,
        own_actions: tuple[str, ...] = (),
    ) -> None:
        self._agent = agent
        self._whereabouts = whereabouts
        self._focused = focused
        self._own_actions = own_actions

    def artifact_for(self, call: Call) -> ArtifactId:
        """The artifact that is to carry out *call*.

        Raises:
            Undelivered: there is none; the message tells similar operations and where they are.
            UnknownArtifact: the workspace that the action is directed to has no artifact of that name.
        """
        intention = call.act.intention
        direction = call.direction
        if direction is ANYWHERE and call.namespace is None:
            # Nearly always it is the only one of the current workspace.
            candidates = self._whereabouts.current(intention).providers(call.name, len(call.arguments))
            if len(candidates) == 1:
                return candidates[0]
        if direction.artifact is not None:
            return self._directed(direction.artifact, call)
        places = self._places(call)
        if call.namespace is not None and direction.workspace is None:
            found = self._in_namespace(call.namespace, call)
            if found is not None:
                return found
        chosen = chosen_artifact(
            places, call.name, len(call.arguments), self._agent, self._focused.in_order()
        )
        if chosen is not None:
            return chosen
        raise nobody_offers(call.act, self._nobody(call, places))

    def _directed(self, wanted: ArtifactId | str, call: Call) -> ArtifactId:
        # An id says all: no annotation beside it counts.
        places = () if isinstance(wanted, ArtifactId) else self._places(call)
        try:
            return self.artifact(wanted, places)
        except UnknownArtifact:
            raise
        except OperationFailed as failure:
            raise unreachable(call.act, failure) from None

    def artifact(self, wanted: ArtifactId | str, places: Sequence[Workspace]) -> ArtifactId:
        """The artifact *wanted*: an id, a name in one of the *places*, or a path that begins in the first of them.

        Raises:
            OperationFailed: there is no such artifact, or its workspace has not been joined.
        """
        if isinstance(wanted, ArtifactId):
            if not self._whereabouts.has_joined(wanted.workspace):
                raise not_joined(wanted.workspace)
            return wanted
        if "/" in wanted:
            above, _, wanted = resolve_path(places[0].path, wanted).rpartition("/")
            places = [self._whereabouts.at(above)]
        return artifact_named(places, wanted)

    def _places(self, call: Call) -> tuple[Workspace, ...]:
        """The workspaces where the artifact may be."""
        wanted, intention = call.direction.workspace, call.act.intention
        if wanted is None:
            return tuple(self._whereabouts.in_order(intention))
        try:
            if isinstance(wanted, str):
                return (self._whereabouts.named(wanted, intention),)
            if not self._whereabouts.has_joined(wanted.path):
                raise not_joined(wanted.path)
        except OperationFailed as failure:
            raise unreachable(call.act, failure) from None
        return (wanted,)

    def _in_namespace(self, namespace: str, call: Call) -> ArtifactId | None:
        """The first artifact focused in a namespace that offers the operation.

        When there are only operations of that name with other numbers of arguments, the first of those is meant, and
        will say so: an action for one robot does not go to another one because of a slip.
        """
        namesake: ArtifactId | None = None
        for workspace, artifact in self._focused.in_namespace(namespace):
            if artifact in workspace.providers(call.name, len(call.arguments)):
                return artifact
            if namesake is None:
                names = (key.rpartition("/")[0] for key in workspace.offers(artifact))
                namesake = artifact if call.name in names else None
        return namesake

    def _nobody(self, call: Call, places: Sequence[Workspace]) -> str:
        where = "workspace" if len(places) == 1 else "the workspaces"
        names = ", ".join(workspace.path for workspace in places)
        return f"no artifact of {where} {names} has an operation {call.key}{self._hint(call, places)}"

    def _hint(self, call: Call, places: Sequence[Workspace]) -> str:
        """What may have been meant: another number of arguments, another spelling, an internal action."""
        offers: dict[str, str] = dict.fromkeys(self._own_actions, "")
        for workspace in places:
            for artifact in workspace.artifacts():
                for key in workspace.offers(artifact):
                    offers.setdefault(key, f" of '{artifact.name}'")
        if call.name.startswith("."):
            return _internal_action_hint(call.name)
        near = [key for key in offers if key.rpartition("/")[0] == call.name]
        if not near:
            if f".{call.name}" in STANDARD:
                return f"; the internal action is written with a dot: .{call.name}"
            near = difflib.get_close_matches(call.key, offers, n=3, cutoff=0.7)
        if not near:
            if (forgotten := _without_mark(call.name, places)) is not None:
                return (
                    f"; the method {call.name} of '{forgotten.name}' is no operation for agents (@operation)"
                )
            nothing = all(a.type_name in DEFAULT_TYPES for w in places for a in w.artifacts())
            return (
                "; no artifact has been made there yet (makeArtifact, or --mapping FILE)" if nothing else ""
            )
        return f"; did you mean {' or '.join(key + offers[key] for key in near[:3])}?"


def _without_mark(name: str, places: Sequence[Workspace]) -> ArtifactId | None:
    """An artifact that has a method of this name which agents cannot call."""
    for workspace in places:
        for artifact in workspace.artifacts():
            if artifact.type_name not in DEFAULT_TYPES and workspace.has_method(artifact, name):
                return artifact
    return None


def _internal_action_hint(name: str) -> str:
    near = difflib.get_close_matches(name, STANDARD, n=1, cutoff=0.75)
    return f"; there is no internal action {name}" + (f", did you mean {near[0]}?" if near else "")
