"""The presence of an agent with a mind: what it has joined and focuses, as beliefs, and the resources it needs."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import chain
from typing import NoReturn

from jacaros.agents.body.values import ADD, REMOVE, PerceptWriter, atom_of
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.state.act import Act, Percept
from jacaros.agents.terms.values import String, Term, functor_of, list_items
from jacaros.artifacts.env.arbiter import POLICIES, Arbiter, Claim, Policy, local_name, read_uses
from jacaros.artifacts.env.artifact import Artifact, Out, internal_operation, operation
from jacaros.artifacts.env.environment import Environment
from jacaros.artifacts.env.errors import ArtifactId, OperationFailed
from jacaros.artifacts.env.ports import Workspace
from jacaros.artifacts.env.property import Observation
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.artifacts.presence.presence import Focused, JoinedWorkspaces, Presence
from jacaros.runtime.files.texts import aside

# The focused artifacts of an agent, whose properties and signals it perceives.


FocusWatcher = Callable[[ArtifactId, bool], None]
"""Called with an artifact that is focused (True) or no longer focused (False)."""


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


class FocusedArtifacts(Focused):
    """The artifacts that one agent focuses.

    For each there is a belief ``focusing(Id,Name,Type,WspId,WspName,WspPath)``.
    """

    def __init__(self, agent: str, writer: PerceptWriter, mind: Mind) -> None:
        super().__init__()
        self._agent = agent
        self._writer = writer
        self._notice: Notice = mind.perceive
        self._untaken = mind.has_untaken
        self._observers: dict[str | None, FocusObserver] = {}
        self._bodies: dict[str, ArtifactId] = {}
        self._watchers: dict[str, FocusWatcher] = {}

    def inhabit(self, workspace: Workspace, body: ArtifactId) -> None:
        """Register the artifact that stands for the agent in a workspace: focused artifacts are a property of it."""
        self._bodies[workspace.path] = body

    def body_in(self, workspace: Workspace) -> ArtifactId:
        """Return the artifact that stands for the agent in a joined workspace."""
        return self._bodies[workspace.path]

    def is_body(self, artifact: ArtifactId) -> bool:
        """Return whether an artifact stands for the agent itself."""
        return self._bodies.get(artifact.workspace) is artifact

    def watch(self, workspace: Workspace, watcher: FocusWatcher) -> Callable[[], None]:
        """Call *watcher* with every artifact of a workspace that is focused (True) or no longer focused (False).
        Return a function that removes it."""
        self._watchers[workspace.path] = watcher
        return lambda: self._watchers.pop(workspace.path, None) and None

    def observer(self, namespace: str | None) -> FocusObserver:
        """Return the observer for a namespace of the agent's program."""
        observer = self._observers.get(namespace)
        if observer is None:
            observer = FocusObserver(self._agent, namespace, self._writer, self._notice, self._untaken)
            self._observers[namespace] = observer
        return observer

    def began(self, workspace: Workspace, artifact: ArtifactId) -> None:
        """Add the belief about a focused artifact."""
        self._report(ADD, workspace, artifact)

    def ended(self, workspace: Workspace, artifact: ArtifactId, disposed: bool) -> None:
        """Remove the belief about an artifact."""
        self._report(REMOVE, workspace, artifact)

    def fall_silent(self) -> None:
        """Send no more percepts to the mind."""
        self._notice = _ignore
        for observer in self._observers.values():
            observer.notice = _ignore

    def _report(self, kind: str, workspace: Workspace, artifact: ArtifactId) -> None:
        self._notice([self._focusing(kind, workspace, artifact)])
        watcher = self._watchers.get(workspace.path)
        if watcher is not None:
            watcher(artifact, kind is ADD)

    def _focusing(self, kind: str, workspace: Workspace, artifact: ArtifactId) -> Percept:
        references = self._writer.references
        arguments: tuple[Term, ...] = (
            references.of(artifact),
            atom_of(artifact.name),
            String(artifact.type_name),
            references.of(workspace),
            atom_of(workspace.name),
            String(workspace.path),
        )
        return self._writer.own(kind, self._bodies[workspace.path], "focusing", *arguments)


def _ignore(percepts: list[Percept]) -> None:
    """Discard percepts after the agent's end."""


# The artifacts that stand for an agent in its workspaces: ``body_bob`` in each, ``session_bob`` in its home.
#
# They show to others what the agent focuses on and where it is. They are made on the first look-up. The agent's own
# operations on them are run by its `AgentBody`.


class AgentBodyArtifact(Artifact):
    """The body of an agent in one workspace.

    Properties:
        focusing(Id, Name, Type, WspId, WspName, WspPath): one for each artifact of the workspace that the agent
            focuses on.
    """

    def init(self, agent: str, focused: FocusedArtifacts, workspace: Workspace) -> None:
        """Show the focused artifacts, and follow changes."""
        self._agent, self._here = agent, workspace
        for artifact in focused.in_workspace(workspace):
            self._show(artifact, True)
        self.on_dispose(focused.watch(workspace, lambda a, present: self.start(self._show, a, present)))

    @internal_operation
    def _show(self, artifact: ArtifactId, present: bool) -> None:
        here = self._here
        values = (artifact, Atom(artifact.name), artifact.type_name, here, Atom(here.name), here.path)
        if present:
            self.define_property("focusing", *values)
        else:
            self.remove_property("focusing", artifact, *(None,) * 5)

    @operation
    def focus(self, artifact: ArtifactId, only: object = None) -> None:
        """Perceive an artifact from now on, optionally only what a filter lets pass."""
        _refuse(self, self._agent)

    @operation(name="focusWhenAvailable")
    def focus_when_available(self, name: str, only: object = None) -> None:
        """Wait until an artifact of that name exists, and perceive it from then on."""
        _refuse(self, self._agent)

    @operation(name="stopFocus")
    def stop_focus(self, artifact: ArtifactId) -> None:
        """Stop perceiving an artifact."""
        _refuse(self, self._agent)


class AgentSessionArtifact(Artifact):
    """The session of an agent.

    Properties:
        joinedWsp(WspId, Name, Path): one for each workspace that the agent has joined.
    """

    def init(self, agent: str, workspaces: JoinedWorkspaces) -> None:
        """Show the joined workspaces, and follow changes."""
        self._agent = agent
        for workspace in workspaces.joined():
            self._show(workspace, True)
        workspaces.watcher = lambda workspace, joined: self.start(self._show, workspace, joined)

    @internal_operation
    def _show(self, workspace: Workspace, joined: bool) -> None:
        if joined:
            self.define_property("joinedWsp", workspace, Atom(workspace.name), workspace.path)
        else:
            self.remove_property("joinedWsp", None, None, workspace.path)

    @operation(name="joinWorkspace")
    def join(self, path: str) -> None:
        """Make a workspace the current one of the intention."""
        _refuse(self, self._agent)

    @operation(name="joinWorkspace")
    def join_and_tell(self, path: str, workspace: Out) -> None:
        """Make a workspace the current one of the intention, and give its id."""
        _refuse(self, self._agent)

    @operation(name="quitWorkspace")
    def quit(self, workspace: object = None) -> None:
        """Leave a workspace."""
        _refuse(self, self._agent)

    @operation(name="quitFromEnvironment")
    def quit_all(self) -> None:
        """Leave all workspaces."""
        _refuse(self, self._agent)


def _refuse(artifact: Artifact, owner: str) -> NoReturn:
    """Fail: the owner's own actions are handled by its body."""
    caller = str(artifact.caller or "nobody")
    artifact.fail(f"{artifact.name} can only be used by {owner}", "security_exception", caller, artifact.name)


class AgentPresence(Presence):
    """The joined workspaces and focused artifacts of an agent with a mind.

    For each joined workspace there is a belief ``joinedWsp(Id,Name,Path)``, and an artifact that stands for the agent.

    Args:
        agent: name of the agent.
        mind: its mind.
        environment: its environment.
        writer: writes percepts, shared by all agents of a run.
        own_actions: the body's own actions, such as ``focus/1``.
    """

    focused: FocusedArtifacts

    def __init__(
        self,
        agent: str,
        mind: Mind,
        environment: Environment,
        writer: PerceptWriter,
        own_actions: tuple[str, ...],
    ) -> None:
        focused = FocusedArtifacts(agent, writer, mind)
        super().__init__(environment, agent, "/main", focused, own_actions)
        self.references = writer.references
        self._perceive, self._writer = mind.perceive, writer
        self._entered = False
        self._session: ArtifactId | None = None

    def enter(self) -> None:
        """Add the belief about the home workspace; at the latest done by the agent's first action."""
        if not self._entered:
            self._entered = True
            self.changed(self.workspaces.home, True)

    def leave(self) -> None:
        """Stop focusing everything, and dispose the artifacts that stand for the agent."""
        if self._session is None:
            return
        for workspace in self.workspaces.joined():
            self._withdraw(workspace, self.focused.body_in(workspace))
        self._withdraw(self.workspaces.home, self._session)
        super().leave()

    def changed(self, workspace: Workspace, joined: bool) -> None:
        """Add or remove the belief about a workspace, and the artifact that stands for the agent there."""
        session = self.session
        if joined:
            made_of = (self.name, self.focused, workspace)
            self.focused.inhabit(workspace, self._offer("body", workspace, AgentBodyArtifact, *made_of))
        about = self.references.of(workspace), atom_of(workspace.name), String(workspace.path)
        self._perceive([self._writer.own(ADD if joined else REMOVE, session, "joinedWsp", *about)])
        if not joined:
            self._withdraw(workspace, self.focused.body_in(workspace))

    @property
    def session(self) -> ArtifactId:
        """The artifact that stands for the agent's session, in its home workspace."""
        if self._session is None:
            made_of = self.name, self.workspaces
            self._session = self._offer("session", self.workspaces.home, AgentSessionArtifact, *made_of)
        return self._session

    def is_own(self, artifact: ArtifactId) -> bool:
        """Return whether an artifact stands for the agent or its session."""
        return artifact is self._session or self.focused.is_body(artifact)

    def _offer(
        self, kind: str, workspace: Workspace, artifact_type: type[Artifact], *arguments: object
    ) -> ArtifactId:
        return workspace.offer(f"{kind}_{self.name}", artifact_type, arguments, personal=True)

    def _withdraw(self, workspace: Workspace, personal: ArtifactId) -> None:
        """Dispose an artifact that stands for the agent, if it still exists."""
        workspace.take_back(personal)
        self.references.forget(personal)
        self._writer.forget(personal)

    def word_for(self, operation: str) -> str | None:
        """Return a suggestion of an internal action."""
        if operation.startswith("."):
            return f"; unknown internal action `{operation}`{aside(operation, STANDARD)}"
        return (
            f"; write the internal action with a dot: .{operation}" if f".{operation}" in STANDARD else None
        )


# Resources that plans of an agent need: claimed, lost, regained and released.


OnNeed = Callable[[OperationFailed | None], None]
OnPreempted = Callable[[str | None], None]


class HeldNeed:
    """The resources of one plan or goal; a claimant of the arbiter.

    Args:
        arbiter: arbiter of the environment.
        yields: whether they may be pre-empted.
        on_done: called when the plan has all its resources for the first time, or with the reason why it cannot have them.
        on_preempted: called with the resource that the plan has lost, and with None when it has it again or no longer
            waits for it.
    """

    def __init__(self, arbiter: Arbiter, yields: bool, on_done: OnNeed, on_preempted: OnPreempted) -> None:
        self._arbiter, self._on_done, self._on_preempted = arbiter, on_done, on_preempted
        self.can_yield = yields
        self._begun = self._lost = False
        self.claim: Claim

    def ask(self, claim: Claim) -> None:
        """Enter the claim."""
        self.claim = claim
        self._arbiter.enter(claim)

    def granted(self, claim: Claim) -> None:
        """Begin or continue the plan."""
        if not self._begun:
            self._begun = True
            self._on_done(None)
        self._found()

    def preempted(self, claim: Claim, resource: str) -> None:
        """Suspend the intention; its operations give way on their own."""
        self._lose(resource)
        self._arbiter.gave_way(claim)

    def refused(self, claim: Claim, reason: Structure | Atom) -> None:
        """Fail the plan, also if its claim was granted before."""
        name = reason.arguments[0] if isinstance(reason, Structure) else ""
        self._on_done(OperationFailed(f"{claim.who} cannot have {name}", reason))

    def pause(self) -> None:
        """Release the resources while the program suspends the intention."""
        self._arbiter.leave(self.claim)
        self._found()

    def resume(self) -> None:
        """Claim the resources again; the intention continues when they are granted."""
        if not self._arbiter.enter(self.claim) and self._begun:
            self._lose(self.claim.uses[0])

    def end(self) -> None:
        """Release the resources."""
        self._arbiter.leave(self.claim)

    def _lose(self, resource: str) -> None:
        if not self._lost:
            self._lost = True
            self._on_preempted(local_name(resource))

    def _found(self) -> None:
        if self._lost:
            self._lost = False
            self._on_preempted(None)


class Needs:
    """All resources that the plans of one agent need.

    Args:
        agent: name of the agent.
        environment: environment with the resources.
    """

    def __init__(self, agent: str, environment: Environment) -> None:
        self._agent, self._environment = agent, environment
        self._held: dict[int, HeldNeed] = {}

    def __contains__(self, number: object) -> bool:
        return number in self._held

    def __getitem__(self, number: int) -> HeldNeed:
        return self._held[number]

    def claims(self, numbers: Iterable[int]) -> tuple[Claim, ...]:
        """Return the claims of the enclosing acts."""
        return tuple(self._held[number].claim for number in numbers if number in self._held)

    def ask(
        self,
        act: Act,
        focused: Iterable[ArtifactId],
        near: Iterable[ArtifactId],
        on_done: OnNeed,
        on_preempted: OnPreempted,
    ) -> None:
        """Claim the resources of an act.

        Args:
            act: names resources, a policy and a goal.
            focused: artifacts whose resources take precedence.
            near: artifacts in the workspaces that the agent has joined.
            on_done: see `HeldNeed`.
            on_preempted: see `HeldNeed`.

        Raises:
            OperationFailed: ``wrong_resource(Name)`` or ``ambiguous_resource(Name)``.
        """
        names, policy, goal = act.arguments
        wanted = _read(str(each) for each in list_items(names))
        uses = tuple(dict.fromkeys(self._resolved(name, focused, near) for name in wanted))
        need = HeldNeed(self._environment.arbiter, act.yields, on_done, on_preempted)
        self._held[act.id] = need
        who = f"[{self._agent}] {goal}"
        blocks = "" if act.yields else self._agent
        within = self.claims(act.within)
        need.ask(Claim(uses, who, need, act.urgency, _policy(policy), within, self._agent, blocks))

    def forget(self, number: int) -> None:
        """Release the resources of an act."""
        need = self._held.pop(number, None)
        if need is not None:
            need.end()

    def close(self) -> None:
        """Release everything."""
        for number in reversed(tuple(self._held)):
            self.forget(number)

    def _resolved(self, name: str, focused: Iterable[ArtifactId], near: Iterable[ArtifactId]) -> str:
        """Resolve a resource: of a focused artifact, else of a near one, else of the run.

        For a robot without a namespace, ``wheels`` is the full name, whatever other robots there are.
        """
        if "/" in name:
            return name
        for artifacts in (focused, near):
            used = chain.from_iterable(map(self._environment.used_by, artifacts))
            meant = dict.fromkeys(each for each in used if local_name(each) == name)
            if name in meant:
                return name
            if len(meant) > 1:
                raise OperationFailed(
                    f"{name} is ambiguous: {', '.join(meant)}; write the full name as a string",
                    Structure("ambiguous_resource", (Atom(name),)),
                )
            if meant:
                return next(iter(meant))
        return name


def _read(names: Iterable[str]) -> tuple[str, ...]:
    listed = tuple(names)
    try:
        return read_uses(listed)
    except ValueError as wrong:
        raise OperationFailed(str(wrong), Structure("wrong_resource", listed)) from None


def _policy(term: object) -> Policy:
    symbol = functor_of(term)
    name = symbol.name if symbol is not None else ""
    if name not in POLICIES:
        raise OperationFailed(
            f"unknown policy `{name}`: expected one of {', '.join(POLICIES)}",
            Structure("wrong_policy", (Atom(name),)),
        )
    return name
