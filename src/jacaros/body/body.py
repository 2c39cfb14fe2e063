"""The body of one agent: runs its actions, and perceives what it focuses on."""

from collections.abc import Callable
from functools import partial
from typing import Protocol

from jacaros.bdi.state.act import NEEDS, Act, Completion, Percept
from jacaros.body.actions import ACTIONS, Action, Situation, keys
from jacaros.body.call import Call, Direction, read
from jacaros.body.completion import SUCCEEDED, Deadline, of_operation, refused, succeeded
from jacaros.body.focus import FocusedArtifacts
from jacaros.body.needs import Needs
from jacaros.body.percepts import ADD, REMOVE, PerceptWriter
from jacaros.body.personal import AgentBodyArtifact, AgentSessionArtifact
from jacaros.body.selection import JoinedWorkspaces, Selection
from jacaros.body.values import Outputs, References, atom_of, to_value
from jacaros.env.artifact import Artifact
from jacaros.env.errors import OperationFailed
from jacaros.env.ids import ArtifactId
from jacaros.env.operation import OperationOutcome, OperationRequest
from jacaros.env.ports import Environment, UnderWay, Workspace
from jacaros.env.values import Structure
from jacaros.terms.text import display
from jacaros.terms.values import String

_CONSOLE = "console"


class ServedMind(Protocol):
    """The interface of a mind for its body (`jacaros.bdi.mind.Mind`)."""

    def perceive(self, percepts: list[Percept]) -> None:
        """Take percepts."""

    def has_untaken(self, name: str) -> bool:
        """Return whether percepts about properties called *name* are still unprocessed."""

    def complete(self, act_id: int, completion: Completion) -> None:
        """Handle the outcome of an act."""

    def preempted(self, act_id: int, resource: str) -> None:
        """Handle that an act has lost a resource."""

    def regained(self, act_id: int) -> None:
        """Handle that an act has its resource again, or no longer waits for it."""


class Activity(Protocol):
    """Counts running actions."""

    def begin(self) -> None:
        """Note that an action has begun."""

    def end(self) -> None:
        """Note that an action has ended or was cancelled."""


class AgentBody:
    """Runs the actions of one agent and perceives for it.

    The percepts of an operation reach the mind before the end of its action: when the plan continues, the belief base
    contains the result.

    Args:
        agent: name of the agent.
        mind: its mind.
        environment: its environment.
        references: opaque references, shared by all agents of a run.
        writer: writes percepts, also shared.
        show: prints a line of the agent's output.
        activity: counts running actions.
        home: full path of the agent's home workspace.
    """

    def __init__(
        self,
        agent: str,
        mind: ServedMind,
        environment: Environment,
        references: References,
        writer: PerceptWriter,
        show: Callable[[str], None],
        activity: Activity,
        home: str = "/main",
    ) -> None:
        self._agent = agent
        self._mind = mind
        self._environment = environment
        self._references = references
        self._writer = writer
        self._show = show
        self._activity = activity
        # Running acts; without a handle until the call that begins them returns.
        self._pending: dict[int, UnderWay | None] = {}
        self._needs = Needs(agent, environment, self)
        self._entered = False
        self._session: ArtifactId | None = None
        self._workspaces = JoinedWorkspaces(environment, home)
        focused = FocusedArtifacts(agent, writer, references, mind.perceive, mind.has_untaken)
        self._selection = Selection(agent, self._workspaces, focused, keys())
        self._situation = Situation(
            agent,
            environment,
            self._workspaces,
            focused,
            self._selection,
            references,
            self._joined,
            self._session_id,
        )

    @property
    def situation(self) -> Situation:
        """The agent's workspaces and focused artifacts."""
        return self._situation

    @property
    def pending(self) -> tuple[int, ...]:
        """The running acts."""
        return tuple(self._pending)

    def enter(self) -> None:
        """Add the belief about the home workspace; at the latest done by the agent's first action."""
        if not self._entered:
            self._entered = True
            for workspace in self._workspaces.joined():
                self._joined(workspace, True)

    def join(self, path: str) -> None:
        """Join a workspace for the project, before the agent acts.

        Raises:
            OperationFailed: no workspace has this full path.
        """
        self.enter()
        workspace = self._environment.workspace(path)
        if self._workspaces.join(workspace):
            self._joined(workspace, True)

    def focus(self, artifact: ArtifactId, namespace: str | None = None) -> None:
        """Focus on an artifact for the project, and join its workspace.

        Raises:
            OperationFailed: the artifact does not exist.
        """
        self.enter()
        workspace = self._environment.workspace(artifact.workspace)
        if not self._workspaces.has_joined(workspace.path):
            self.join(workspace.path)
        self._situation.focused.begin(workspace, artifact, namespace)

    def act(self, act: Act) -> None:
        """Begin an action; the mind receives its outcome, possibly before this returns."""
        if not self._entered:
            self.enter()
        self._pending[act.id] = None
        self._activity.begin()
        if act.functor is NEEDS:
            self._need(act)
            return
        try:
            handle = self._begin(read(act))
        except OperationFailed as failure:
            self._finish(act.id, refused(failure, self._references))
            return
        if act.id in self._pending:
            self._pending[act.id] = handle

    def cancel_act(self, act_id: int) -> None:
        """Cancel the operation of an action without reporting its end; or release the resources of a plan."""
        self._needs.forget(act_id)
        if act_id not in self._pending:
            return
        handle = self._pending.pop(act_id)
        self._activity.end()
        if handle is not None:
            handle.cancel()

    def suspend_act(self, act_id: int) -> None:
        """Pause the operation of an action if it is pausable; or lend the resources of a plan to others."""
        if act_id in self._needs:
            self._needs[act_id].pause()
        handle = self._pending.get(act_id)
        if handle is not None:
            handle.pause()

    def resume_act(self, act_id: int) -> None:
        """Resume the operation of an action; or claim the resources of a plan again."""
        if act_id in self._needs:
            self._needs[act_id].resume()
        handle = self._pending.get(act_id)
        if handle is not None:
            handle.resume()

    def close(self) -> None:
        """Cancel all actions and stop focusing everything; the mind receives nothing more."""
        self._situation.focused.fall_silent()
        for act_id in self.pending:
            self.cancel_act(act_id)
        self._needs.close()
        if self._session is None:
            return
        focused = self._situation.focused
        for workspace in self._workspaces.joined():
            focused.end_all(workspace)
            self._withdraw(workspace, focused.body_in(workspace))
        self._withdraw(self._workspaces.home, self._session)

    # ---- resources of plans

    def _need(self, act: Act) -> None:
        focused = self._situation.focused.in_order()
        near = [each for workspace in self._workspaces.joined() for each in workspace.artifacts()]
        try:
            self._needs.ask(act, focused, near)
        except OperationFailed as failure:
            self._finish(act.id, refused(failure, self._references))

    def acquired(self, number: int) -> None:
        """Report that a plan has its resources."""
        self._finish(number, SUCCEEDED)

    def unavailable(self, number: int, failure: OperationFailed) -> None:
        """Report that a plan does not get its resources; one that has begun fails at its next claim."""
        self._needs.forget(number)
        self._finish(number, refused(failure, self._references))

    def preempted(self, number: int, resource: str) -> None:
        """Report that a plan has lost a resource."""
        self._mind.preempted(number, resource)

    def regained(self, number: int) -> None:
        """Report that a plan has its resource again, or no longer waits for it."""
        self._mind.regained(number)

    def _on_preempted(self, number: int, resource: str | None) -> None:
        if resource is None:
            self._mind.regained(number)
        else:
            self._mind.preempted(number, resource)

    def _begin(self, call: Call) -> UnderWay | None:
        action = ACTIONS.get((call.name, len(call.arguments)))
        if action is not None and call.direction.artifact is None:
            return self._by_itself(action, call)
        artifact = self._selection.artifact_for(call)
        if action is not None and self._is_own(artifact, call):
            here = self._environment.workspace(artifact.workspace) if artifact is not self._session else None
            call.direction = Direction(None, here, call.direction.timeout)
            return self._by_itself(action, call)
        if artifact.creator is None and artifact.name == _CONSOLE and _prints(call):
            # Printed here and not by the console artifact, which would receive values, while users want terms.
            self._show("".join(map(display, call.arguments)))
            self._finish(call.act.id, succeeded())
            return None
        return self._execute(call, artifact)

    def _by_itself(self, action: Action, call: Call) -> UnderWay | None:
        finish = partial(self._finish, call.act.id)
        if call.direction.timeout is None:
            return action(self._situation, call, finish)
        deadline = Deadline(call, self._environment.clock, finish, self._references)
        try:
            return deadline.watch(action(self._situation, call, deadline.ended))
        except OperationFailed:
            deadline.cancel()
            raise

    def _is_own(self, artifact: ArtifactId, call: Call) -> bool:
        """Return whether an artifact stands for the agent itself, and has that operation."""
        if artifact is not self._session and not self._situation.focused.is_body(artifact):
            return False
        return call.key in self._environment.workspace(artifact.workspace).offers(artifact)

    def _execute(self, call: Call, artifact: ArtifactId) -> UnderWay:
        act = call.act
        outputs: Outputs = []
        arguments = []
        try:
            for argument in call.arguments:
                arguments.append(to_value(argument, outputs))
        except RecursionError:
            raise _too_deep(artifact, call.key) from None
        done = partial(self._done, act.id, outputs)
        timeout = call.direction.timeout
        tracer, why = self._environment.tracer, act.cause
        if tracer is not None:
            why = tracer.link("act", f"{self._agent} {call.key}", why, (self._agent, act))
        request = OperationRequest(artifact, call.name, tuple(arguments), self._agent, why, done, timeout)
        request.urgency, request.yields = act.urgency, act.yields
        if act.within:
            request.within = self._needs.claims(act.within)
        request.on_preempted = partial(self._on_preempted, act.id)
        return self._environment.execute(request)

    def _done(self, act_id: int, outputs: Outputs, outcome: OperationOutcome) -> None:
        if outcome.ok and not outputs:
            self._finish(act_id, SUCCEEDED)
        else:
            self._finish(act_id, of_operation(outcome, outputs, self._references))

    def _finish(self, act_id: int, completion: Completion) -> None:
        if act_id in self._pending:
            del self._pending[act_id]
            self._activity.end()
            self._mind.complete(act_id, completion)

    def _joined(self, workspace: Workspace, is_in: bool) -> None:
        session = self._session_id()
        focused = self._situation.focused
        if is_in:
            made_of = (self._agent, focused, workspace)
            focused.inhabit(workspace, self._offer("body", workspace, AgentBodyArtifact, *made_of))
        percept = self._writer.own(
            ADD if is_in else REMOVE,
            session,
            "joinedWsp",
            self._references.of(workspace),
            atom_of(workspace.name),
            String(workspace.path),
        )
        self._mind.perceive([percept])
        if not is_in:
            self._withdraw(workspace, focused.body_in(workspace))

    def _session_id(self) -> ArtifactId:
        if self._session is None:
            made = (self._agent, self._workspaces)
            self._session = self._offer("session", self._workspaces.home, AgentSessionArtifact, *made)
        return self._session

    def _offer(
        self, kind: str, workspace: Workspace, artifact_type: type[Artifact], *arguments: object
    ) -> ArtifactId:
        return workspace.offer(f"{kind}_{self._agent}", artifact_type, arguments, personal=True)

    def _withdraw(self, workspace: Workspace, personal: ArtifactId) -> None:
        """Dispose an artifact that stands for the agent, if it still exists."""
        workspace.take_back(personal)
        self._references.forget(personal)
        self._writer.forget(personal)


def _too_deep(artifact: ArtifactId, key: str) -> OperationFailed:
    """Return the failure of an action with an argument that exceeds Python's nesting limit."""
    message = f"an argument of {key} is nested too deeply for a Python value"
    return OperationFailed(message, Structure("wrong_op_arguments", (artifact, key)))


def _prints(call: Call) -> bool:
    return call.name in ("print", "println", "printWithAgName", "printlnWithAgName")
