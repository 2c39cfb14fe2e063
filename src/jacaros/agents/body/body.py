"""The body of one agent: runs its actions, and perceives what it focuses on."""

from collections.abc import Callable
from functools import partial
from typing import Protocol

from jacaros.agents.body.actions import ACTIONS, Action, keys
from jacaros.agents.body.call import (
    SUCCEEDED,
    Call,
    Deadline,
    of_operation,
    read,
    refused,
    succeeded,
    undelivered,
)
from jacaros.agents.body.needs import Needs
from jacaros.agents.body.percepts import PerceptWriter
from jacaros.agents.body.presence import AgentPresence, PerceivingMind
from jacaros.agents.body.values import Outputs, to_value
from jacaros.agents.mind.state.act import NEEDS, Act, Completion
from jacaros.agents.terms.text import display
from jacaros.artifacts.env.environment import Environment
from jacaros.artifacts.env.errors import ArtifactId, OperationFailed, UnknownArtifact
from jacaros.artifacts.env.operation import OperationOutcome, OperationRequest
from jacaros.artifacts.env.ports import ENDED, UnderWay
from jacaros.artifacts.env.values import Structure
from jacaros.artifacts.presence.perception import Activity
from jacaros.artifacts.presence.presence import ANYWHERE, Direction, UnknownOperation

_CONSOLE = "console"


class ServedMind(PerceivingMind, Protocol):
    """The interface of a mind for its body (`jacaros.agents.mind.mind.Mind`)."""

    def complete(self, act_id: int, completion: Completion) -> None:
        """Handle the outcome of an act."""

    def preempted(self, act_id: int, resource: str) -> None:
        """Handle that an act has lost a resource."""

    def regained(self, act_id: int) -> None:
        """Handle that an act has its resource again, or no longer waits for it."""


class AgentBody(AgentPresence):
    """Runs the actions of one agent and perceives for it.

    The percepts of an operation reach the mind before the end of its action: when the plan continues, the belief base
    contains the result.

    Args:
        agent: name of the agent.
        mind: its mind.
        environment: its environment.
        writer: writes percepts, shared by all agents of a run.
        show: prints a line of the agent's output.
        activity: counts running actions.
    """

    def __init__(
        self,
        agent: str,
        mind: ServedMind,
        environment: Environment,
        writer: PerceptWriter,
        show: Callable[[str], None],
        activity: Activity,
    ) -> None:
        super().__init__(agent, mind, environment, writer, keys())
        self._mind = mind
        self._show = show
        self._activity = activity
        # Running acts; without a handle of their own until the call that begins them returns.
        self._pending: dict[int, UnderWay] = {}
        self._needs = Needs(agent, environment)

    @property
    def pending(self) -> tuple[int, ...]:
        """The running acts."""
        return tuple(self._pending)

    def act(self, act: Act) -> None:
        """Begin an action; the mind receives its outcome, possibly before this returns."""
        self.enter()
        self._pending[act.id] = ENDED
        self._activity.begin()
        if act.functor is NEEDS:
            self._need(act)
            return
        try:
            handle = self._begin(read(act))
        except OperationFailed as failure:
            self._finish(act.id, refused(failure, self.references))
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
        handle.cancel()

    def suspend_act(self, act_id: int) -> None:
        """Pause the operation of an action if it is pausable; or lend the resources of a plan to others."""
        if act_id in self._needs:
            self._needs[act_id].pause()
        self._pending.get(act_id, ENDED).pause()

    def resume_act(self, act_id: int) -> None:
        """Resume the operation of an action; or claim the resources of a plan again."""
        if act_id in self._needs:
            self._needs[act_id].resume()
        self._pending.get(act_id, ENDED).resume()

    def close(self) -> None:
        """Cancel all actions and stop focusing everything; the mind receives nothing more."""
        self.focused.fall_silent()
        for act_id in self.pending:
            self.cancel_act(act_id)
        self._needs.close()
        self.leave()

    # ---- resources of plans

    def _need(self, act: Act) -> None:
        focused = self.focused.in_order()
        near = [each for workspace in self.workspaces.joined() for each in workspace.artifacts()]
        on_done, on_preempted = partial(self._need_ended, act.id), partial(self._on_preempted, act.id)
        try:
            self._needs.ask(act, focused, near, on_done, on_preempted)
        except OperationFailed as failure:
            self._finish(act.id, refused(failure, self.references))

    def _need_ended(self, number: int, failure: OperationFailed | None) -> None:
        """Report that a plan has its resources, or cannot have them; one that has begun fails at its next claim."""
        if failure is None:
            self._finish(number, SUCCEEDED)
        else:
            self._needs.forget(number)
            self._finish(number, refused(failure, self.references))

    def _on_preempted(self, number: int, resource: str | None) -> None:
        if resource is None:
            self._mind.regained(number)
        else:
            self._mind.preempted(number, resource)

    def _begin(self, call: Call) -> UnderWay:
        action = ACTIONS.get((call.name, len(call.arguments)))
        if action is not None and call.direction.artifact is None:
            return self._by_itself(action, call)
        artifact = self._artifact_for(call)
        if action is not None and self.is_own(artifact) and self._offers(artifact, call):
            at_home = artifact is self.session
            here = None if at_home else self.environment.workspace(artifact.workspace)
            call.direction = Direction(None, here, call.direction.timeout)
            return self._by_itself(action, call)
        if artifact.creator is None and artifact.name == _CONSOLE and _prints(call):
            # Printed here and not by the console artifact, which would receive values, while users want terms.
            self._show("".join(map(display, call.arguments)))
            self._finish(call.act.id, succeeded())
            return ENDED
        return self._execute(call, artifact)

    def _by_itself(self, action: Action, call: Call) -> UnderWay:
        finish = partial(self._finish, call.act.id)
        if call.direction.timeout is None:
            return action(self, call, finish) or ENDED
        deadline = Deadline(call, self.environment.clock, finish, self.references)
        try:
            return deadline.watch(action(self, call, deadline.ended) or ENDED)
        except OperationFailed:
            deadline.cancel()
            raise

    def _offers(self, artifact: ArtifactId, call: Call) -> bool:
        return call.key in self.environment.workspace(artifact.workspace).offers(artifact)

    def _artifact_for(self, call: Call) -> ArtifactId:
        direction, intention = call.direction, call.act.intention
        try:
            return self.artifact_for(call.name, len(call.arguments), direction, intention, call.namespace)
        except UnknownArtifact:
            raise
        except OperationFailed as failure:
            if isinstance(failure, UnknownOperation) or direction is not ANYWHERE:
                raise undelivered(call.act, failure) from None
            raise

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
        tracer, why = self.environment.tracer, act.cause
        if tracer is not None:
            why = tracer.link("act", f"{self.name} {call.key}", why, (self.name, act))
        request = OperationRequest(artifact, call.name, tuple(arguments), self.name, why, done, timeout)
        request.urgency, request.yields = act.urgency, act.yields
        if act.within:
            request.within = self._needs.claims(act.within)
        request.on_preempted = partial(self._on_preempted, act.id)
        return self.environment.execute(request)

    def _done(self, act_id: int, outputs: Outputs, outcome: OperationOutcome) -> None:
        if outcome.ok and not outputs:
            self._finish(act_id, SUCCEEDED)
        else:
            self._finish(act_id, of_operation(outcome, outputs, self.references))

    def _finish(self, act_id: int, completion: Completion) -> None:
        if act_id in self._pending:
            del self._pending[act_id]
            self._activity.end()
            self._mind.complete(act_id, completion)


def _too_deep(artifact: ArtifactId, key: str) -> OperationFailed:
    """Return the failure of an action with an argument that exceeds Python's nesting limit."""
    message = f"an argument of {key} is nested too deeply for a Python value"
    return OperationFailed(message, Structure("wrong_op_arguments", (artifact, key)))


def _prints(call: Call) -> bool:
    return call.name in ("print", "println", "printWithAgName", "printlnWithAgName")
