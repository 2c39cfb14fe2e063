"""Which artifact runs an action: the rules of CArtAgO's bridge to Jason.

An annotation of the action directs it: ``artifact_id`` (``aid``) before ``artifact_name`` (``art``), inside the
workspace given by ``wid`` or ``wsp``. With a namespace in front of the action, the artifacts focused in that
namespace come first. Otherwise the workspaces are searched: the current one of the intention, the agent's home, then
the others that it has joined (see `jacaros.env.lookup` for several candidates in one).
"""

from collections.abc import Callable, Iterator, Sequence

from jacaros.bdi.actions.internal_action import STANDARD
from jacaros.body.call import (
    ANYWHERE,
    Call,
    nobody_offers,
    unreachable,
)
from jacaros.body.focus import FocusedArtifacts
from jacaros.env.errors import OperationFailed, UnknownArtifact
from jacaros.env.ids import ArtifactId, resolve_path
from jacaros.env.lookup import artifact_named, chosen_artifact, in_order, joined_workspace
from jacaros.env.ports import Environment, Workspace
from jacaros.env.standard_artifacts import DEFAULT_TYPES
from jacaros.env.values import Structure
from jacaros.suggestions import aside, close_matches


class JoinedWorkspaces:
    """The joined workspaces of one agent.

    An intention that has joined a workspace stays there; others use the workspace that the agent joined last.

    Args:
        environment: contains the workspaces.
        home: full path of the agent's home workspace.

    Attributes:
        home: the agent's home workspace.
        watcher: called with each workspace that is joined (True) or quit (False).
    """

    REMEMBERED_INTENTIONS = 1000
    """The end of intentions is not reported, so only the last ones that joined a workspace are remembered."""

    def __init__(self, environment: Environment, home: str = "/main") -> None:
        self._environment = environment
        self.home = environment.workspace(home)
        self._joined: dict[str, Workspace] = {home: self.home}
        self._last = self.home
        self.watcher: Callable[[Workspace, bool], None] | None = None
        self._of_intention: dict[int, Workspace] = {}

    def joined(self) -> tuple[Workspace, ...]:
        """The joined workspaces, in the order of joining."""
        return tuple(self._joined.values())

    def has_joined(self, path: str) -> bool:
        """Return whether the agent has joined the workspace with that full path."""
        return path in self._joined

    def at(self, path: str) -> Workspace:
        """Return the joined workspace with that full path.

        Raises:
            OperationFailed: the agent has not joined it.
        """
        if path not in self._joined:
            raise not_joined(path)
        return self._joined[path]

    def current(self, intention: int) -> Workspace:
        """Return the workspace of an intention.

        Raises:
            OperationFailed: the agent has quit all workspaces.
        """
        found = self._of_intention.get(intention, self._last) if self._of_intention else self._last
        if found.path in self._joined:
            return found
        if not self._joined:
            raise not_joined(self.home.path)
        return self._last

    def in_order(self, intention: int) -> Iterator[Workspace]:
        """Yield the workspaces in an intention's search order: the current one, home, then the others."""
        return in_order(self._joined, self.current(intention), self.home)

    def find(self, path: str, intention: int) -> Workspace:
        """Return the workspace at *path*, relative to the intention's current workspace, or to home.

        Raises:
            OperationFailed: it does not exist.
        """
        base = self.current(intention) if self._joined else self.home
        return self._environment.workspace(resolve_path(base.path, path))

    def named(self, name: str, intention: int) -> Workspace:
        """Return the joined workspace with that path or plain name.

        Raises:
            OperationFailed: the agent has not joined such a workspace.
        """
        current = self.current(intention)
        found = joined_workspace(self._environment, self._joined, current, self.home, name)
        if found is None:
            raise not_joined(name)
        return found

    def join(self, workspace: Workspace, intention: int | None = None) -> bool:
        """Make a workspace the current one. Return True if it was not joined before."""
        is_new = workspace.path not in self._joined
        self._joined[workspace.path] = workspace
        self._last = workspace
        if is_new and self.watcher is not None:
            self.watcher(workspace, True)
        if intention is not None:
            self._of_intention.pop(intention, None)
            self._of_intention[intention] = workspace
            if len(self._of_intention) > self.REMEMBERED_INTENTIONS:
                del self._of_intention[next(iter(self._of_intention))]
        return is_new

    def quit(self, workspace: Workspace) -> bool:
        """Leave a workspace. Return False if it was not joined.

        When none is left, the agent can only join one again.
        """
        if self._joined.pop(workspace.path, None) is None:
            return False
        if self._last is workspace:
            self._last = next(reversed(self._joined.values()), self.home)
        if self.watcher is not None:
            self.watcher(workspace, False)
        return True


def not_joined(path: str) -> OperationFailed:
    """Return the failure of an action in a workspace that the agent has not joined."""
    return OperationFailed(
        f'workspace {path} has not been joined; write joinWorkspace("{path}") first',
        Structure("workspace_not_joined", (path,)),
    )


class Selection:
    """Artifact resolution for one agent.

    Args:
        agent: name of the agent.
        workspaces: its workspaces.
        focused: its focused artifacts.
        own_actions: names with numbers of arguments of the body's own actions, for suggestions.
    """

    def __init__(
        self,
        agent: str,
        workspaces: JoinedWorkspaces,
        focused: FocusedArtifacts,
        own_actions: tuple[str, ...] = (),
    ) -> None:
        self._agent = agent
        self._workspaces = workspaces
        self._focused = focused
        self._own_actions = own_actions

    def artifact_for(self, call: Call) -> ArtifactId:
        """Return the artifact that runs *call*.

        Raises:
            Undelivered: none exists; the message names similar operations and their places.
            UnknownArtifact: the workspace that the action is directed to has no artifact of that name.
        """
        intention = call.act.intention
        direction = call.direction
        if direction is ANYWHERE and call.namespace is None:
            # Nearly always it is the only one of the current workspace.
            candidates = self._workspaces.current(intention).providers(call.name, len(call.arguments))
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
        # An id is complete: other annotations are ignored.
        places = () if isinstance(wanted, ArtifactId) else self._places(call)
        try:
            return self.artifact(wanted, places)
        except UnknownArtifact:
            raise
        except OperationFailed as failure:
            raise unreachable(call.act, failure) from None

    def artifact(self, wanted: ArtifactId | str, places: Sequence[Workspace]) -> ArtifactId:
        """Return the artifact *wanted*: an id, a name in one of the *places*, or a path relative to the first of
        them.

        Raises:
            OperationFailed: the artifact does not exist, or the agent has not joined its workspace.
        """
        if isinstance(wanted, ArtifactId):
            if not self._workspaces.has_joined(wanted.workspace):
                raise not_joined(wanted.workspace)
            return wanted
        if "/" in wanted:
            above, _, wanted = resolve_path(places[0].path, wanted).rpartition("/")
            places = [self._workspaces.at(above)]
        return artifact_named(places, wanted)

    def _places(self, call: Call) -> tuple[Workspace, ...]:
        """Return the workspaces that may contain the artifact."""
        wanted, intention = call.direction.workspace, call.act.intention
        if wanted is None:
            return tuple(self._workspaces.in_order(intention))
        try:
            if isinstance(wanted, str):
                return (self._workspaces.named(wanted, intention),)
            if not self._workspaces.has_joined(wanted.path):
                raise not_joined(wanted.path)
        except OperationFailed as failure:
            raise unreachable(call.act, failure) from None
        return (wanted,)

    def _in_namespace(self, namespace: str, call: Call) -> ArtifactId | None:
        """Return the first artifact focused in a namespace that offers the operation.

        If there are only operations of that name with other numbers of arguments, return the first of these, which
        reports the mismatch: after a slip, an action for one robot must not reach another one.
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
        """Return a suggestion: another number of arguments, another spelling, an internal action."""
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
                return f"; write the internal action with a dot: .{call.name}"
            near = close_matches(call.key, offers, 3)
        if not near:
            if (forgotten := _without_mark(call.name, places)) is not None:
                return (
                    f"; the method `{call.name}` of `{forgotten.name}` is not an operation (add @operation)"
                )
            nothing = all(a.type_name in DEFAULT_TYPES for w in places for a in w.artifacts())
            return "; the workspace has no artifacts yet (makeArtifact, or --mapping FILE)" if nothing else ""
        return f"; did you mean {' or '.join(f'`{key}`{offers[key]}' for key in near[:3])}?"


def _without_mark(name: str, places: Sequence[Workspace]) -> ArtifactId | None:
    """Return an artifact with a method of this name that is not an operation."""
    for workspace in places:
        for artifact in workspace.artifacts():
            if artifact.type_name not in DEFAULT_TYPES and workspace.has_method(artifact, name):
                return artifact
    return None


def _internal_action_hint(name: str) -> str:
    return f"; unknown internal action `{name}`{aside(name, STANDARD)}"
