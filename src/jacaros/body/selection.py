"""Which artifact carries out an action: the rules of CArtAgO's bridge to Jason.

An annotation of the action directs it: ``artifact_id`` (``aid``) before ``artifact_name`` (``art``), inside
the workspace given by ``wid`` or ``wsp``.  A namespace in front of the action means the artifacts focused in
that namespace first.  Otherwise the workspaces are gone through: the current one of the intention, the
agent's home, then the others that it has joined (see `jacaros.env.choice` for several candidates in one).
"""

import difflib
from collections.abc import Iterable, Sequence

from jacaros.bdi.internal_action import STANDARD
from jacaros.body.call import ANYWHERE, Call
from jacaros.body.focus import FocusedArtifacts
from jacaros.body.whereabouts import Whereabouts, not_joined
from jacaros.env.choice import artifact_named, chosen_artifact
from jacaros.env.errors import OperationFailed
from jacaros.env.ids import ArtifactId
from jacaros.env.values import Structure
from jacaros.env.workspace import Workspace


class Selection:
    """Selects artifacts for one agent.

    Args:
        agent: name of the agent.
        whereabouts: its workspaces.
        focused: its focused artifacts.
        own_actions: names with numbers of arguments of what its body does without any artifact, for hints.
    """

    def __init__(
        self, agent: str, whereabouts: Whereabouts, focused: FocusedArtifacts, own_actions: Iterable[str] = ()
    ) -> None:
        self._agent = agent
        self._whereabouts = whereabouts
        self._focused = focused
        self._own_actions = tuple(own_actions)

    def artifact_for(self, call: Call) -> ArtifactId:
        """The artifact that is to carry out *call*.

        Raises:
            OperationFailed: there is none; the message tells similar operations and where they are.
        """
        intention = call.act.intention
        direction = call.direction
        if direction is ANYWHERE and call.namespace is None:
            # Nearly always it is the only one of the current workspace.
            candidates = self._whereabouts.current(intention).providers(call.name, len(call.arguments))
            if len(candidates) == 1:
                return candidates[0]
        places = self._places(direction.workspace, intention)
        if direction.artifact is not None:
            return self.artifact(direction.artifact, places)
        if call.namespace is not None:
            for artifact in self._focused.in_namespace(call.namespace):
                if self._offers(artifact, call):
                    return artifact
        chosen = chosen_artifact(
            places, call.name, len(call.arguments), self._agent, self._focused.in_order()
        )
        if chosen is not None:
            return chosen
        raise self._nobody(call, places)

    def artifact(self, wanted: ArtifactId | str, places: Sequence[Workspace]) -> ArtifactId:
        """The artifact *wanted*: an id, or a name in one of the *places*.

        Raises:
            OperationFailed: there is no such artifact, or its workspace has not been joined.
        """
        if isinstance(wanted, ArtifactId):
            if not self._whereabouts.has_joined(wanted.workspace):
                raise not_joined(wanted.workspace)
            return wanted
        return artifact_named(places, wanted)

    def _places(self, wanted: Workspace | str | None, intention: int) -> tuple[Workspace, ...]:
        if wanted is None:
            return tuple(self._whereabouts.in_order(intention))
        if isinstance(wanted, str):
            return (self._whereabouts.named(wanted, intention),)
        if not self._whereabouts.has_joined(wanted.path):
            raise not_joined(wanted.path)
        return (wanted,)

    def _offers(self, artifact: ArtifactId, call: Call) -> bool:
        for workspace in self._whereabouts.joined():
            if workspace.path == artifact.workspace:
                return artifact in workspace.providers(call.name, len(call.arguments))
        return False

    def _nobody(self, call: Call, places: Sequence[Workspace]) -> OperationFailed:
        where = "workspace" if len(places) == 1 else "the workspaces"
        names = ", ".join(workspace.path for workspace in places)
        message = f"no artifact of {where} {names} has an operation {call.key}{self._hint(call, places)}"
        return OperationFailed(message, Structure("unknown_operation", (call.name,)))

    def _hint(self, call: Call, places: Sequence[Workspace]) -> str:
        """What may have been meant: another number of arguments, another spelling, an internal action."""
        offers: dict[str, str] = dict.fromkeys(self._own_actions, "")
        for workspace in places:
            for artifact in workspace.artifacts():
                operations = workspace.interface(artifact).operations
                for key in operations.keys():  # noqa: SIM118 - it is no dictionary
                    offers.setdefault(key, f" of '{artifact.name}'")
        if call.name.startswith("."):
            return _internal_action_hint(call.name)
        near = [key for key in offers if key.rpartition("/")[0] == call.name]
        if not near:
            if f".{call.name}" in STANDARD:
                return f"; the internal action is written with a dot: .{call.name}"
            near = difflib.get_close_matches(call.key, offers, n=3, cutoff=0.7)
        if not near:
            nothing = not any(a.creator is not None for w in places for a in w.artifacts())
            return "; no artifact has been made there yet (makeArtifact)" if nothing else ""
        return f"; did you mean {' or '.join(key + offers[key] for key in near[:3])}?"


def _internal_action_hint(name: str) -> str:
    near = difflib.get_close_matches(name, STANDARD, n=1, cutoff=0.75)
    return f"; there is no internal action {name}" + (f", did you mean {near[0]}?" if near else "")
