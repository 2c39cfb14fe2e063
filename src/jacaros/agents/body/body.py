"""The body of an agent with a mind: it reads acts, and runs them as operations or as actions of the environment."""

import asyncio
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cache, partial
from types import MappingProxyType
from typing import Final

from jacaros.agents.body.presence import AgentPresence, Needs
from jacaros.agents.body.values import (
    Outputs,
    PerceptWriter,
    References,
    symbol_name,
    to_term,
    to_value,
    unquoted,
)
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.state.act import NEEDS, Act, Activity, Completion
from jacaros.agents.terms.text import display, text
from jacaros.agents.terms.values import (
    NIL,
    Annotated,
    Functor,
    Reference,
    String,
    Term,
    Var,
    atom,
    bare,
    deref,
    functor,
    is_list,
)
from jacaros.artifacts.env.environment import Environment
from jacaros.artifacts.env.errors import ArtifactId, OperationFailed, UnknownArtifact
from jacaros.artifacts.env.execution import OperationExecution
from jacaros.artifacts.env.operation import OperationOutcome, OperationRequest
from jacaros.artifacts.env.ports import ENDED, OnOutcome, UnderWay, Workspace
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.artifacts.presence.presence import (
    ANYWHERE,
    Direction,
    Filter,
    UnknownOperation,
    filter_of,
)
from jacaros.runtime.clock import Clock
from jacaros.runtime.files.texts import aside

# An external action as the body reads it: its name, arguments and direction.
#
# Actions that reach no artifact fail as in CArtAgO's bridge to Jason (`Undelivered`).

_ARTIFACT = ("artifact", ArtifactId, "an artifact (from makeArtifact or lookupArtifact)")
_WORKSPACE = ("workspace", Workspace, "a workspace (from joinWorkspace)")
_TARGETS: dict[str, tuple[str, type, str]] = {
    **dict.fromkeys(("artifact_id", "aid", "artifact_name", "art"), _ARTIFACT),
    **dict.fromkeys(("wid", "wsp"), _WORKSPACE),
}
"""Annotations that direct an action: the part of `Direction` that they give, its class, and words for it."""
_TIMEOUT = "timeout"
_DIRECTIONS = (*_TARGETS, _TIMEOUT)


@dataclass(slots=True)
class Call:
    """One external action.

    Attributes:
        act: the request of the mind.
        name: name of the action, without quotes.
        namespace: namespace of the name, None without.
        arguments: dereferenced terms.
        direction: content of the annotations.
    """

    act: Act
    name: str
    namespace: str | None
    arguments: tuple[Term, ...]
    direction: Direction

    @property
    def key(self) -> str:
        """Name and number of arguments, such as ``inc/1``."""
        return f"{self.name}/{len(self.arguments)}"


def _direction(act: Act) -> Direction:
    """Return what the annotations of an act say.

    Raises:
        Undelivered: an annotation is invalid.
    """
    direction = Direction()
    # An id takes precedence over a name, in whatever order they are written.
    for annotation in sorted(act.annotations, key=lambda a: _name(a) in ("artifact_id", "aid", "wid")):
        name = _name(annotation)
        if annotation.__class__ is not tuple or name == "source":
            continue
        if len(annotation) == 2 and name == _TIMEOUT:
            direction.timeout = _seconds(act, annotation)
            continue
        if len(annotation) != 2 or name not in _TARGETS:
            message = f"unknown annotation `{text(annotation)}` of action `{act.functor}`"
            help = aside(name, _DIRECTIONS) or f"; the annotations of actions are {', '.join(_DIRECTIONS)}"
            raise unknown_annotation(act, annotation, message + help)
        setattr(direction, _TARGETS[name][0], _target(act, annotation[1], name))
    return direction


def _seconds(act: Act, annotation: Term) -> float:
    """Return the time in ``timeout(Milliseconds)``."""
    milliseconds = deref(annotation[1])
    if milliseconds.__class__ is not float or not 0 <= milliseconds < float("inf"):
        wanted = f"timeout: expected a number of milliseconds, found {text(milliseconds)}"
        raise unknown_annotation(act, annotation, f"{act.functor!r}: {wanted}")
    return float(milliseconds) / 1000


def _name(annotation: Term) -> str:
    return annotation[0].name if annotation.__class__ is tuple else ""


def _target(act: Act, term: Term, annotation: str) -> object:
    """Return the artifact or workspace in an annotation, or its name.

    Raises:
        Undelivered: it is neither.
    """
    _, kind, what = _TARGETS[annotation]
    term = bare(term)
    if term.__class__ is Reference and isinstance(term.value, kind):
        return term.value
    name = name_of(term)
    if name is None:
        message = f"{annotation}: expected {what} or its name, found {text(term)}"
        reason = Structure("wrong_op_arguments", (annotation,))
        raise undelivered(act, OperationFailed(message, reason))
    return name


def name_of(term: Term) -> str | None:
    """Return the text of a string or atom, without quotes; None for other terms."""
    if term.__class__ is String:
        return str(term)
    return symbol_name(term) if term.__class__ is Functor else None


_ENV_FAILURE = functor("env_failure", 1)
_ACTION_FAILED = functor("action_failed", 2)
_OP = functor("op", 2)
_GENERIC_ERROR, _UNKNOWN_ANNOTATION = atom("generic_error"), atom("unknown_annotation")


class Undelivered(OperationFailed):
    """Raised for an action that reaches no artifact.

    Attributes:
        term: the content of ``env_failure_reason``.
        reason: the content of ``env_failure_detail``.
    """

    def __init__(self, message: str, term: Term, reason: Structure | Atom | None) -> None:
        super().__init__(message, reason)
        self.term = term


def undelivered(act: Act, failure: OperationFailed) -> Undelivered:
    """Return the failure of an action that no artifact offers, or that is directed to where the agent cannot act."""
    symbol = act.functor
    why: Term = _GENERIC_ERROR
    if isinstance(failure, UnknownOperation):
        words = " ".join(("(", unquoted(symbol.name), *map(_words, act.arguments), ")"))
        why = (_OP, atom(symbol.namespace or "default"), String(words))
    term = (_ENV_FAILURE, (_ACTION_FAILED, atom(symbol.name), why))
    return Undelivered(failure.message, term, failure.reason)


def _words(term: Term) -> str:
    term = deref(term)
    return str(term) if term.__class__ is String else text(term)


def unknown_annotation(act: Act, annotation: Term, message: str) -> Undelivered:
    """Return the failure of an action with an unknown annotation."""
    symbol = act.functor
    action = Annotated((symbol, *act.arguments) if act.arguments else symbol, act.annotations)
    reason = Structure("unknown_annotation", (text(annotation),))
    return Undelivered(message, (_ACTION_FAILED, action, _UNKNOWN_ANNOTATION), reason)


# Outcomes of actions, as reported to the mind.
#
# One of them is the time-out of an action: ``focusWhenAvailable(door)[timeout(500)]``.


SUCCEEDED = Completion(True)

_ERROR_MSG = functor("error_msg", 1)
_ENV_FAILURE_REASON = functor("env_failure_reason", 1)
_ENV_FAILURE_DETAIL = functor("env_failure_detail", 1)


def succeeded(*outputs: tuple[Term, Term]) -> Completion:
    """Return the outcome of an action that succeeded, with values for its output variables."""
    return Completion(True, outputs) if outputs else SUCCEEDED


def failed(message: str, reason: Structure | Atom | None, references: References) -> Completion:
    """Return the outcome of a failed action: ``error_msg``, and ``env_failure_reason`` if there is a reason."""
    annotations: tuple[Term, ...] = ((_ERROR_MSG, String(message)),)
    if reason is not None:
        annotations += ((_ENV_FAILURE_REASON, to_term(reason, references)),)
    return Completion(False, (), annotations)


def refused(failure: OperationFailed, references: References) -> Completion:
    """Return the outcome of an action that failed before or outside of an operation."""
    if not isinstance(failure, Undelivered):
        return failed(failure.message, failure.reason, references)
    annotations: tuple[Term, ...] = (
        (_ERROR_MSG, String(failure.message)),
        (_ENV_FAILURE_REASON, failure.term),
    )
    if failure.reason is not None:
        annotations += ((_ENV_FAILURE_DETAIL, to_term(failure.reason, references)),)
    return Completion(False, (), annotations)


def of_operation(outcome: OperationOutcome, outputs: Outputs, references: References) -> Completion:
    """Return the outcome of an operation, with the values of its output parameters."""
    if not outcome.ok:
        return failed(outcome.message or "", outcome.reason, references)
    if not outputs:
        return SUCCEEDED
    return Completion(True, tuple(_values(outputs, references)))


def _values(outputs: Outputs, references: References) -> Iterable[tuple[Term, Term]]:
    for variable, out in outputs:
        if out.is_set and out.value is not None:
            yield variable, to_term(out.value, references)


Finish = Callable[[Completion], None]
"""Called once with the outcome of an action."""


class ActionTimeout:
    """Cancels an action when its time is over.

    Args:
        call: the action, with its time limit.
        clock: clock of the run.
        finish: called with the outcome.
        references: for the failure reason.
    """

    def __init__(self, call: Call, clock: Clock, finish: Finish, references: References) -> None:
        self._call, self._finish, self._references = call, finish, references
        self._under_way: UnderWay = ENDED
        self._timer = clock.call_later(call.direction.timeout or 0.0, self._late)

    def ended(self, completion: Completion) -> None:
        """Note that the action has ended in time."""
        self._timer.cancel()
        self._finish(completion)

    def watch(self, under_way: UnderWay) -> UnderWay:
        """Set the handle to cancel; the returned one replaces it."""
        self._under_way = under_way
        return self

    def _late(self) -> None:
        self._under_way.cancel()
        milliseconds = round((self._call.direction.timeout or 0.0) * 1000, 3)
        message = f"{self._call.key} did not end within {milliseconds:g} ms"
        reason = Structure("operation_timeout", (self._call.key, milliseconds))
        self._finish(failed(message, reason, self._references))

    def cancel(self) -> None:
        """Cancel the action without reporting its end."""
        self._timer.cancel()
        self._under_way.cancel()

    def pause(self) -> None:
        """Pause the action, if possible; its time continues."""
        self._under_way.pause()

    def resume(self) -> None:
        """Resume the action."""
        self._under_way.resume()


# Actions of an agent's own body: make artifacts, focus, join and quit workspaces.
#
# In CArtAgO these are operations of the artifacts ``workspace``, ``body_bob`` and ``session_bob``; the actions,
# arguments and failure reasons are the same here. All other actions on workspaces belong to the artifact ``workspace``
# (`jacaros.artifacts.env.environment`).


_Bound = tuple[tuple[Term, Term], ...]
"""Values for output variables of an action."""


StartAction = Callable[[AgentPresence, Call, Finish], UnderWay | None]
"""Runs a call; returns a handle if it is still running afterwards.

Raises OperationFailed if that is impossible.
"""

_declared: dict[tuple[str, int], StartAction] = {}
ACTIONS: Final[Mapping[tuple[str, int], StartAction]] = MappingProxyType(_declared)
"""The actions by name and number of arguments."""


def _action(name: str, *arities: int) -> Callable[[StartAction], StartAction]:
    def register(action: StartAction) -> StartAction:
        _declared.update({(name, arity): action for arity in arities})
        return action

    return register


@cache
def keys() -> tuple[str, ...]:
    """Return names with numbers of arguments, such as ``focus/1``; one tuple for all agents."""
    return tuple(f"{name}/{arity}" for name, arity in ACTIONS)


def _give(presence: AgentPresence, call: Call, holder: ArtifactId, index: int, value: object) -> _Bound:
    """Return the output *value* for an argument of a call, if the call has that argument.

    Raises:
        OperationFailed: the argument is not a variable.
    """
    if index >= len(call.arguments):
        return ()
    argument = call.arguments[index]
    if argument.__class__ is not Var:
        raise _wrong(call, holder, f"argument {index + 1} is an output: expected an unbound variable", index)
    return ((argument, presence.references.of(value)),)


def _wrong(call: Call, holder: ArtifactId, what: str, index: int) -> OperationFailed:
    """Return the failure of an action with an argument of the wrong kind."""
    return OperationFailed(
        f"{call.key}: {what}, found {text(call.arguments[index])}",
        Structure("wrong_op_arguments", (holder, call.key)),
    )


def _base(presence: AgentPresence, call: Call) -> Workspace:
    """Return the workspace that a call is directed to, or the current one.

    Raises:
        OperationFailed: the agent has not joined it.
    """
    wanted = call.direction.workspace
    try:
        return presence.base(wanted, call.act.intention)
    except OperationFailed as failure:
        raise failure if wanted is None else undelivered(call.act, failure) from None


def _name_of(call: Call, index: int, holder: ArtifactId, what: str = "a name (a string or an atom)") -> str:
    name = name_of(bare(call.arguments[index]))
    if name is None:
        raise _wrong(call, holder, f"argument {index + 1}: expected {what}", index)
    return name


def _artifact(presence: AgentPresence, call: Call) -> ArtifactId:
    """Return the artifact whose id is the first argument.

    Raises:
        OperationFailed: it is not an id, or the agent has not joined the artifact's workspace.
    """
    term = bare(call.arguments[0])
    artifact = term.value if term.__class__ is Reference else None
    if not isinstance(artifact, ArtifactId):
        help = " (lookupArtifact gives the id for a name)" if name_of(term) is not None else ""
        what = f"argument 1: expected the id of an artifact{help}"
        raise _wrong(call, presence.focused.body_in(_base(presence, call)), what, 0)
    presence.workspaces.at(artifact.workspace)
    return artifact


def _reported(presence: AgentPresence, finish: Finish) -> OnOutcome:
    """Convert the outcome of a request to a workspace to that of an action."""
    return lambda outcome: finish(of_operation(outcome, [], presence.references))


@_action("makeArtifact", 2, 3, 4)
def make_artifact(presence: AgentPresence, call: Call, finish: Finish) -> UnderWay:
    """``makeArtifact(Name, Type [, Parameters [, -Id]])``: make an artifact.

    It is made in the current workspace, in the one that the action is directed to, or in the one that precedes the
    name.
    """
    here = _base(presence, call)
    holder = here.lookup("workspace")
    name, type_name = _name_of(call, 0, holder), _name_of(call, 1, holder, "the name of a type")
    parameters = bare(call.arguments[2]) if len(call.arguments) > 2 else NIL
    if not is_list(parameters):
        help = "; the id is the fourth argument" if parameters.__class__ is Var else ""
        raise _wrong(call, holder, f"argument 3: expected a list of parameters{help}", 2)
    _give(presence, call, holder, 3, holder)
    workspace, plain_name = presence.environment.place(here, name)

    def made(artifact: ArtifactId | None, outcome: OperationOutcome) -> None:
        if artifact is None:
            finish(failed(outcome.message or "", outcome.reason, presence.references))
        else:
            finish(succeeded(*_give(presence, call, holder, 3, artifact)))

    return workspace.create(plain_name, type_name, to_value(parameters), presence.name, made)


@_action("focus", 1, 2)
def focus(presence: AgentPresence, call: Call, finish: Finish) -> None:
    """``focus(Id [, Filter])``: perceive an artifact from now on, optionally only what a filter lets pass."""
    artifact, only = _artifact(presence, call), _filter(presence, call)
    if presence.is_own(artifact):
        # An agent always perceives everything of its own body and session.
        finish(succeeded())
        return
    workspace = presence.workspaces.at(artifact.workspace)
    presence.focused.begin(workspace, artifact, call.namespace, _reported(presence, finish), only)


def _filter(presence: AgentPresence, call: Call) -> Filter | None:
    """Return the filter in the second argument; None without a second argument."""
    if len(call.arguments) == 1:
        return None
    found = filter_of(to_value(call.arguments[1]))
    if found is None:
        what = "argument 2: expected a filter: a pattern such as count(_), or a list of patterns"
        raise _wrong(call, presence.focused.body_in(_base(presence, call)), what, 1)
    return found


@_action("focusWhenAvailable", 1, 2)
def focus_when_available(presence: AgentPresence, call: Call, finish: Finish) -> UnderWay:
    """``focusWhenAvailable(Name [, Filter])``: wait until an artifact of that name exists, and focus on it."""
    here = _base(presence, call)
    name = _name_of(call, 0, presence.focused.body_in(here))
    only = _filter(presence, call)
    told = _reported(presence, finish)
    return presence.focus_when_available(here, name, lambda _, outcome: told(outcome), call.namespace, only)


@_action("stopFocus", 1)
def stop_focus(presence: AgentPresence, call: Call, finish: Finish) -> None:
    """``stopFocus(Id)``: stop perceiving an artifact; no effect if it is not focused."""
    artifact = _artifact(presence, call)
    # A disposed artifact cannot be referred to; its percepts are already gone.
    presence.workspaces.at(artifact.workspace).offers(artifact)
    presence.focused.end(artifact, call.namespace)
    finish(succeeded())


@_action("joinWorkspace", 1, 2)
def join_workspace(presence: AgentPresence, call: Call, finish: Finish) -> None:
    """``joinWorkspace(Path [, -Id])``: make a workspace the current one of the intention."""
    intention, session = call.act.intention, presence.session
    workspace = _workspace(call, session)
    if workspace is None:
        workspace = presence.workspaces.find(_name_of(call, 0, session), intention)
    output = _give(presence, call, session, 1, workspace)
    presence.join(workspace, intention)
    finish(succeeded(*output))


def _workspace(call: Call, session: ArtifactId) -> Workspace | None:
    """Return the workspace whose id is the first argument; None if that is a name."""
    term = bare(call.arguments[0])
    if term.__class__ is Reference and isinstance(term.value, Workspace):
        return term.value
    if name_of(term) is None:
        raise _wrong(
            call, session, "argument 1: expected a workspace (its path, or the id from joinWorkspace)", 0
        )
    return None


@_action("quitWorkspace", 0, 1)
def quit_workspace(presence: AgentPresence, call: Call, finish: Finish) -> None:
    """``quitWorkspace([Id])``: leave a workspace (default: the current one) and stop focusing everything in it."""
    if not call.arguments:
        workspace = _base(presence, call)
    else:
        session = presence.session
        workspace = _workspace(call, session) or presence.workspaces.named(
            _name_of(call, 0, session), call.act.intention
        )
    presence.quit(workspace)
    finish(succeeded())


@_action("quitFromEnvironment", 0)
def quit_from_environment(presence: AgentPresence, call: Call, finish: Finish) -> None:
    """``quitFromEnvironment``: leave all workspaces; ``joinWorkspace`` returns."""
    for workspace in reversed(presence.workspaces.joined()):
        presence.quit(workspace)
    finish(succeeded())


_CONSOLE = "console"
_PRINTING = "print", "println", "printWithAgName", "printlnWithAgName"


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
        mind: Mind,
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
        if not self._entered:
            self.enter()
        self._pending[act.id] = ENDED
        self._activity.pending += 1
        if act.functor is NEEDS:
            self._need(act)
            return
        symbol, arguments = act.functor, act.arguments
        name = unquoted(symbol.name) if symbol.name[0] == "'" else symbol.name
        for argument in arguments:
            if argument.__class__ is Var:
                arguments = tuple(map(deref, arguments))
                break
        try:
            direction = _direction(act) if act.annotations else ANYWHERE
            handle = self._begin(Call(act, name, symbol.namespace, arguments, direction))
        except OperationFailed as failure:
            self._finish(act.id, refused(failure, self.references))
            return
        if act.id in self._pending:
            self._pending[act.id] = handle

    def task_of(self, act_id: int) -> "asyncio.Task[None] | None":
        """Return the task of an action's operation, which ends with its clean-up; None if it has none here."""
        handle = self._pending.get(act_id)
        return handle.task if isinstance(handle, OperationExecution) else None

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
        direction = call.direction
        try:
            artifact = self.artifact_for(
                call.name, len(call.arguments), direction, call.act.intention, call.namespace
            )
        except UnknownArtifact:
            raise
        except OperationFailed as failure:
            if isinstance(failure, UnknownOperation) or direction is not ANYWHERE:
                raise undelivered(call.act, failure) from None
            raise
        if action is not None and self.is_own(artifact):
            workspace = self.environment.workspace(artifact.workspace)
            if call.key in workspace.offers(artifact):
                call.direction = Direction(
                    None, None if artifact is self.session else workspace, direction.timeout
                )
                return self._by_itself(action, call)
        if artifact.creator is None and artifact.name == _CONSOLE and call.name in _PRINTING:
            # Printed here and not by the console artifact, which would receive values, while users want terms.
            self._show("".join(map(display, call.arguments)))
            self._finish(call.act.id, succeeded())
            return ENDED
        return self._execute(call, artifact)

    def _by_itself(self, action: StartAction, call: Call) -> UnderWay:
        finish = partial(self._finish, call.act.id)
        if call.direction.timeout is None:
            return action(self, call, finish) or ENDED
        deadline = ActionTimeout(call, self.environment.clock, finish, self.references)
        try:
            return deadline.watch(action(self, call, deadline.ended) or ENDED)
        except OperationFailed:
            deadline.cancel()
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
