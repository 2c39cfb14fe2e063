"""The presence of an agent, a script or a behaviour tree in an environment.

CArtAgO's rules decide which artifact serves an operation. A `Direction` selects it: an artifact by id, or by its name in
the given workspace. With a namespace, the artifacts focused in that namespace come first. Otherwise the workspaces are
searched: the current one, home, then the others (see `jacaros.artifacts.env.creation` for several candidates in one).
"""

from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass

from jacaros.artifacts.env.creation import artifact_named, chosen_artifact
from jacaros.artifacts.env.environment import DEFAULT_TYPES, Environment
from jacaros.artifacts.env.errors import ArtifactId, OperationFailed, UnknownArtifact, resolve_path
from jacaros.artifacts.env.operation import OperationOutcome
from jacaros.artifacts.env.ports import ENDED, OnMade, UnderWay, Waiting, Workspace
from jacaros.artifacts.env.values import Structure
from jacaros.artifacts.presence.joined import Filter, Focused, JoinedWorkspaces
from jacaros.files.texts import close_matches


@dataclass(slots=True)
class Direction:
    """What an operation is directed to, and its time limit.

    Attributes:
        artifact: an artifact, its name, or its path; None if not given. With an id, *workspace* is ignored.
        workspace: a workspace, or its name or path; None if not given.
        timeout: seconds; None: no limit.
    """

    artifact: ArtifactId | str | None = None
    workspace: Workspace | str | None = None
    timeout: float | None = None


ANYWHERE = Direction()
"""The direction of operations without one; immutable by convention."""


class UnknownOperation(OperationFailed):
    """No artifact offers an operation."""


class Presence:
    """The joined workspaces and focused artifacts of one agent, script or behaviour tree.

    Args:
        environment: the environment.
        name: name of the agent or session: creator of artifacts, caller of operations.
        home: full path of the workspace that it joins first.
        focused: its focused artifacts.
        own_actions: actions that are not operations, such as ``focus/1``, for suggestions.

    Raises:
        UnknownWorkspace: the workspace *home* does not exist.
    """

    def __init__(
        self,
        environment: Environment,
        name: str,
        home: str,
        focused: Focused,
        own_actions: Iterable[str] = (),
    ) -> None:
        self.environment, self.name, self.focused = environment, name, focused
        self.workspaces = JoinedWorkspaces(environment, home)
        self._own_actions = own_actions

    # ---- workspaces

    def join(self, workspace: Workspace, intention: int | None = None) -> None:
        """Join a workspace and make it the current one."""
        if self.workspaces.join(workspace, intention):
            self.changed(workspace, True)

    def quit(self, workspace: Workspace) -> None:
        """Leave a workspace, and stop focusing its artifacts.

        Raises:
            OperationFailed: it is not joined; reason ``workspace_not_joined(Name)``.
        """
        self.workspaces.at(workspace.path)
        self.focused.end_all(workspace)
        self.workspaces.quit(workspace)
        self.changed(workspace, False)

    def leave(self) -> None:
        """End everything silently: waits for artifacts, too."""
        for workspace in self.workspaces.joined():
            self.focused.end_all(workspace)
            self.workspaces.quit(workspace)

    def changed(self, workspace: Workspace, joined: bool) -> None:
        """Note that a workspace was joined (True) or quit (False)."""

    def base(self, wanted: Workspace | str | None, intention: int | None = None) -> Workspace:
        """Return the joined workspace *wanted*; None means the current one.

        Raises:
            OperationFailed: it is not joined.
        """
        if wanted is None:
            return self.workspaces.current(intention)
        return (
            self.workspaces.named(wanted, intention)
            if isinstance(wanted, str)
            else self.workspaces.at(wanted.path)
        )

    # ---- artifacts

    def artifact(self, wanted: ArtifactId | str, places: Sequence[Workspace]) -> ArtifactId:
        """Return the artifact *wanted*: an id, a name in one of the *places*, or a path relative to the first of them.

        Raises:
            OperationFailed: the artifact does not exist, or its workspace is not joined.
        """
        if isinstance(wanted, ArtifactId):
            self.workspaces.at(wanted.workspace)
            return wanted
        if "/" in wanted:
            above, _, wanted = resolve_path(places[0].path, wanted).rpartition("/")
            places = [self.workspaces.at(above)]
        return artifact_named(places, wanted)

    def artifact_for(
        self,
        operation: str,
        arity: int,
        direction: Direction = ANYWHERE,
        intention: int | None = None,
        namespace: str | None = None,
    ) -> ArtifactId:
        """Return the artifact that serves an operation.

        Raises:
            UnknownOperation: none exists; the message names similar operations and their places.
            UnknownArtifact: the workspace that the operation is directed to has no artifact of that name.
            OperationFailed: that workspace is not joined.
        """
        if direction is ANYWHERE and namespace is None:
            # Nearly always it is the only one of the current workspace.
            candidates = self.workspaces.current(intention).providers(operation, arity)
            if len(candidates) == 1:
                return candidates[0]
        wanted = direction.artifact
        if isinstance(wanted, ArtifactId):
            return self.artifact(wanted, ())
        if direction.workspace is None:
            places = tuple(self.workspaces.in_order(intention))
        else:
            places = (self.base(direction.workspace, intention),)
        if wanted is not None:
            return self.artifact(wanted, places)
        found = None
        if namespace is not None and direction.workspace is None:
            found = self._in_namespace(namespace, operation, arity)
        found = found or chosen_artifact(places, operation, arity, self.name, self.focused.in_order())
        if found is None:
            raise self._unknown(operation, arity, places)
        return found

    def _in_namespace(self, namespace: str, operation: str, arity: int) -> ArtifactId | None:
        """Return the first artifact focused in a namespace that offers the operation.

        If there are only operations of that name with other numbers of arguments, return the first of these, which
        reports the mismatch: after a slip, an action for one robot must not reach another one.
        """
        namesake: ArtifactId | None = None
        for workspace, artifact in self.focused.in_namespace(namespace):
            if artifact in workspace.providers(operation, arity):
                return artifact
            if namesake is None and operation in map(_name, workspace.offers(artifact)):
                namesake = artifact
        return namesake

    # ---- focus

    def focus_when_available(
        self,
        here: Workspace,
        path: str,
        on_done: OnMade,
        namespace: str | None = None,
        only: Filter | None = None,
    ) -> UnderWay:
        """Focus an artifact as soon as one with this name or path exists. See `Focused.begin`.

        Args:
            here: workspace that *path* is relative to.
            path: name or path of the artifact.
            on_done: called with the artifact, or the failure: its workspace was quit meanwhile.
            namespace: namespace of the agent's program.
            only: filter of what is perceived.

        Returns:
            The handle of the wait.

        Raises:
            OperationFailed: its workspace does not exist, or is not joined.
        """
        workspace, name = self.environment.place(here, path)
        self.workspaces.at(workspace.path)

        def begin(artifact: ArtifactId) -> None:
            def focused(outcome: OperationOutcome) -> None:
                on_done(artifact if outcome.ok else None, outcome)

            self.focused.begin(workspace, artifact, namespace, focused, only)

        def look(artifact: ArtifactId, is_there: bool) -> None:
            if not is_there or artifact.name != name:
                return
            try:
                self.workspaces.at(workspace.path)
                begin(artifact)
            except UnknownArtifact:
                return  # it was disposed immediately: wait for the next one
            except OperationFailed as failure:
                on_done(None, OperationOutcome.of(failure))
            waiting.cancel()

        with suppress(UnknownArtifact):
            begin(workspace.lookup(name))
            return ENDED
        waiting = Waiting(workspace.watch(look))
        return waiting

    # ---- unknown operations

    def word_for(self, operation: str) -> str | None:
        """Return a suggestion for the name of an unknown operation that is a word of something else, or None."""

    def _unknown(self, operation: str, arity: int, places: Sequence[Workspace]) -> UnknownOperation:
        where = "workspace" if len(places) == 1 else "the workspaces"
        names, key = ", ".join(workspace.path for workspace in places), f"{operation}/{arity}"
        message = f"no artifact of {where} {names} has an operation {key}{self._hint(operation, key, places)}"
        return UnknownOperation(message, Structure("unknown_operation", (key,)))

    def _hint(self, operation: str, key: str, places: Sequence[Workspace]) -> str:
        """Return a suggestion: another number of arguments, another spelling, a word of something else."""
        offers = dict.fromkeys(self._own_actions, "")
        for place, artifact in _artifacts(places):
            for each in place.offers(artifact):
                offers.setdefault(each, f" of '{artifact.name}'")
        near = [each for each in offers if _name(each) == operation]
        if not near:
            if (word := self.word_for(operation)) is not None:
                return word
            near = close_matches(key, offers, 3)
        if near:
            return f"; did you mean {' or '.join(f'`{each}`{offers[each]}' for each in near[:3])}?"
        own = [
            (place, artifact)
            for place, artifact in _artifacts(places)
            if artifact.type_name not in DEFAULT_TYPES
        ]
        for place, artifact in own:
            if place.has_method(artifact, operation):
                return f"; the method `{operation}` of `{artifact.name}` is not an operation (add @operation)"
        return "" if own else "; the workspace has no artifacts yet (makeArtifact, or --mapping FILE)"


def _artifacts(places: Sequence[Workspace]) -> list[tuple[Workspace, ArtifactId]]:
    return [(place, artifact) for place in places for artifact in place.artifacts()]


def _name(key: str) -> str:
    return key.rpartition("/")[0]
