"""Actions of an agent's own body: make artifacts, focus, join and quit workspaces.

In CArtAgO these are operations of the artifacts ``workspace``, ``body_bob`` and ``session_bob``; the actions,
arguments and failure reasons are the same here. All other actions on workspaces belong to the artifact ``workspace``
(`jacaros.env.workspace_artifact`).
"""

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import cache, partial
from types import MappingProxyType
from typing import Final

from jacaros.bdi.state.act import Completion
from jacaros.body.call import Call, name_of, unreachable
from jacaros.body.completion import failed, of_operation, refused, succeeded
from jacaros.body.filtering import Filter, filter_of
from jacaros.body.focus import FocusedArtifacts
from jacaros.body.selection import JoinedWorkspaces, Selection, not_joined
from jacaros.body.values import References, to_value
from jacaros.env.errors import OperationFailed, UnknownArtifact
from jacaros.env.ids import ArtifactId, resolve_path
from jacaros.env.operation import OperationOutcome
from jacaros.env.ports import Environment, OnOutcome, UnderWay, Workspace
from jacaros.env.values import Structure
from jacaros.terms.text import text
from jacaros.terms.values import NIL, Reference, Term, Var, bare, is_list

Outputs = tuple[tuple[Term, Term], ...]
"""Values for output variables of an action."""

Finish = Callable[[Completion], None]
"""Called once with the outcome of an action."""


@dataclass(frozen=True, slots=True)
class Situation:
    """An agent and its environment.

    Attributes:
        agent: name of the agent.
        environment: the environment.
        workspaces: the workspaces that it has joined.
        focused: its focused artifacts.
        selection: its artifact resolution.
        references: opaque references of the run.
        joined: called with every workspace that it joins (True) or quits (False).
        session: returns the artifact that stands for its session.
    """

    agent: str
    environment: Environment
    workspaces: JoinedWorkspaces
    focused: FocusedArtifacts
    selection: Selection
    references: References
    joined: Callable[[Workspace, bool], None]
    session: Callable[[], ArtifactId]


Action = Callable[[Situation, Call, Finish], UnderWay | None]
"""Runs a call; returns a handle if it is still running afterwards.

Raises OperationFailed if that is impossible.
"""

_declared: dict[tuple[str, int], Action] = {}
ACTIONS: Final[Mapping[tuple[str, int], Action]] = MappingProxyType(_declared)
"""The actions by name and number of arguments."""


def _action(name: str, *arities: int) -> Callable[[Action], Action]:
    def register(action: Action) -> Action:
        _declared.update({(name, arity): action for arity in arities})
        return action

    return register


@cache
def keys() -> tuple[str, ...]:
    """Return names with numbers of arguments, such as ``focus/1``; one tuple for all agents."""
    return tuple(f"{name}/{arity}" for name, arity in ACTIONS)


def _give(situation: Situation, call: Call, holder: ArtifactId, index: int, value: object) -> Outputs:
    """Return the output *value* for an argument of a call, if the call has that argument.

    Raises:
        OperationFailed: the argument is not a variable.
    """
    if index >= len(call.arguments):
        return ()
    argument = call.arguments[index]
    if argument.__class__ is not Var:
        raise _wrong(call, holder, f"argument {index + 1} is an output: expected an unbound variable", index)
    return ((argument, situation.references.of(value)),)


def _wrong(call: Call, holder: ArtifactId, what: str, index: int) -> OperationFailed:
    """Return the failure of an action with an argument of the wrong kind."""
    return OperationFailed(
        f"{call.key}: {what}, found {text(call.arguments[index])}",
        Structure("wrong_op_arguments", (holder, call.key)),
    )


def _base(situation: Situation, call: Call) -> Workspace:
    """Return the workspace that a call is directed to, or the current one.

    Raises:
        OperationFailed: the agent has not joined it.
    """
    workspaces, intention = situation.workspaces, call.act.intention
    wanted = call.direction.workspace
    if wanted is None:
        return workspaces.current(intention)
    try:
        if isinstance(wanted, str):
            return workspaces.named(wanted, intention)
        if not workspaces.has_joined(wanted.path):
            raise not_joined(wanted.path)
    except OperationFailed as failure:
        raise unreachable(call.act, failure) from None
    return wanted


def _place(situation: Situation, here: Workspace, path: str) -> tuple[Workspace, str]:
    """Return the workspace and the plain name of an artifact, given its name or path."""
    if "/" not in path:
        return here, path
    above, _, name = resolve_path(here.path, path).rpartition("/")
    return situation.environment.workspace(above), name


def _name(call: Call, index: int, holder: ArtifactId, what: str = "a name (a string or an atom)") -> str:
    """Return the name in an argument."""
    name = name_of(bare(call.arguments[index]))
    if name is None:
        raise _wrong(call, holder, f"argument {index + 1}: expected {what}", index)
    return name


def _artifact(situation: Situation, call: Call) -> ArtifactId:
    """Return the artifact whose id is the first argument.

    Raises:
        OperationFailed: it is not an id, or the agent has not joined the artifact's workspace.
    """
    term = bare(call.arguments[0])
    artifact = term.value if term.__class__ is Reference else None
    if not isinstance(artifact, ArtifactId):
        help = " (lookupArtifact gives the id for a name)" if name_of(term) is not None else ""
        what = f"argument 1: expected the id of an artifact{help}"
        raise _wrong(call, situation.focused.body_in(_base(situation, call)), what, 0)
    if not situation.workspaces.has_joined(artifact.workspace):
        raise not_joined(artifact.workspace)
    return artifact


def _workspace_of(situation: Situation, artifact: ArtifactId) -> Workspace:
    return situation.environment.workspace(artifact.workspace)


def _reported(situation: Situation, finish: Finish) -> OnOutcome:
    """Convert the outcome of a request to a workspace to that of an action."""
    return lambda outcome: finish(of_operation(outcome, [], situation.references))


@_action("makeArtifact", 2, 3, 4)
def make_artifact(situation: Situation, call: Call, finish: Finish) -> UnderWay | None:
    """``makeArtifact(Name, Type [, Parameters [, -Id]])``: make an artifact.

    It is made in the current workspace, in the one that the action is directed to, or in the one that precedes the
    name.
    """
    here = _base(situation, call)
    holder = here.lookup("workspace")
    name, type_name = _name(call, 0, holder), _name(call, 1, holder, "the name of a type")
    parameters = bare(call.arguments[2]) if len(call.arguments) > 2 else NIL
    if not is_list(parameters):
        help = "; the id is the fourth argument" if parameters.__class__ is Var else ""
        raise _wrong(call, holder, f"argument 3: expected a list of parameters{help}", 2)
    _give(situation, call, holder, 3, holder)
    workspace, plain_name = _place(situation, here, name)

    def made(artifact: ArtifactId | None, outcome: OperationOutcome) -> None:
        if artifact is None:
            finish(failed(outcome.message or "", outcome.reason, situation.references))
        else:
            finish(succeeded(*_give(situation, call, holder, 3, artifact)))

    return workspace.create(plain_name, type_name, to_value(parameters), situation.agent, made)


@_action("focus", 1, 2)
def focus(situation: Situation, call: Call, finish: Finish) -> None:
    """``focus(Id [, Filter])``: perceive an artifact from now on, optionally only what a filter lets pass."""
    artifact, only = _artifact(situation, call), _filter(situation, call)
    if situation.focused.is_body(artifact) or artifact is situation.session():
        # An agent always perceives everything of its own body and session.
        finish(succeeded())
        return
    workspace, told = _workspace_of(situation, artifact), _reported(situation, finish)
    situation.focused.begin(workspace, artifact, call.namespace, told, only)


def _filter(situation: Situation, call: Call) -> Filter | None:
    """Return the filter in the second argument; None without a second argument."""
    if len(call.arguments) == 1:
        return None
    complain = partial(
        situation.environment.log_error, situation.agent, "a filter failed; everything passes:"
    )
    found = filter_of(to_value(call.arguments[1]), complain)
    if found is None:
        what = "argument 2: expected a filter: patterns such as count(_), or a Python object with a method select"
        raise _wrong(call, situation.focused.body_in(_base(situation, call)), what, 1)
    return found


class _Waiting:
    """Waits for an artifact that does not exist yet."""

    def __init__(self, stop: Callable[[], None]) -> None:
        self._stop = stop

    def cancel(self) -> None:
        self._stop()

    def pause(self) -> None:
        """Do nothing: waiting needs no pause."""

    def resume(self) -> None:
        """Do nothing."""


@_action("focusWhenAvailable", 1, 2)
def focus_when_available(situation: Situation, call: Call, finish: Finish) -> UnderWay | None:
    """``focusWhenAvailable(Name [, Filter])``: wait until an artifact of that name exists, and focus on it."""
    here = _base(situation, call)
    name = _name(call, 0, situation.focused.body_in(here))
    only = _filter(situation, call)
    workspace, wanted = _place(situation, here, name)
    if not situation.workspaces.has_joined(workspace.path):
        raise not_joined(workspace.path)
    present = next((a for a in workspace.artifacts() if a.name == wanted), None)
    if present is not None:
        situation.focused.begin(workspace, present, call.namespace, _reported(situation, finish), only)
        return None

    def look(artifact: ArtifactId, is_there: bool) -> None:
        if not is_there or artifact.name != wanted:
            return
        if not situation.workspaces.has_joined(workspace.path):
            stop()
            finish(refused(not_joined(workspace.path), situation.references))
            return
        with suppress(UnknownArtifact):  # it was disposed immediately: wait for the next one
            situation.focused.begin(workspace, artifact, call.namespace, _reported(situation, finish), only)
            stop()

    stop = workspace.watch(look)
    return _Waiting(stop)


@_action("stopFocus", 1)
def stop_focus(situation: Situation, call: Call, finish: Finish) -> None:
    """``stopFocus(Id)``: stop perceiving an artifact; no effect if it is not focused."""
    artifact = _artifact(situation, call)
    # A disposed artifact cannot be referred to; its percepts are already gone.
    _workspace_of(situation, artifact).offers(artifact)
    situation.focused.end(artifact, call.namespace)
    finish(succeeded())


@_action("joinWorkspace", 1, 2)
def join_workspace(situation: Situation, call: Call, finish: Finish) -> None:
    """``joinWorkspace(Path [, -Id])``: make a workspace the current one of the intention."""
    intention, session = call.act.intention, situation.session()
    workspace = _workspace(call, session)
    if workspace is None:
        workspace = situation.workspaces.find(_name(call, 0, session), intention)
    output = _give(situation, call, session, 1, workspace)
    if situation.workspaces.join(workspace, intention):
        situation.joined(workspace, True)
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
def quit_workspace(situation: Situation, call: Call, finish: Finish) -> None:
    """``quitWorkspace([Id])``: leave a workspace (default: the current one) and stop focusing everything in it."""
    intention = call.act.intention
    if not call.arguments:
        workspace = _base(situation, call)
    else:
        session = situation.session()
        workspace = _workspace(call, session) or situation.workspaces.named(
            _name(call, 0, session), intention
        )
    if not situation.workspaces.has_joined(workspace.path):
        raise not_joined(workspace.path)
    _quit(situation, workspace)
    finish(succeeded())


@_action("quitFromEnvironment", 0)
def quit_from_environment(situation: Situation, call: Call, finish: Finish) -> None:
    """``quitFromEnvironment``: leave all workspaces; ``joinWorkspace`` returns."""
    for workspace in reversed(situation.workspaces.joined()):
        _quit(situation, workspace)
    finish(succeeded())


def _quit(situation: Situation, workspace: Workspace) -> None:
    situation.focused.end_all(workspace)
    situation.workspaces.quit(workspace)
    situation.joined(workspace, False)
