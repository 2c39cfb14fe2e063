"""Actions of an agent's own body: make artifacts, focus, join and quit workspaces.

In CArtAgO these are operations of the artifacts ``workspace``, ``body_bob`` and ``session_bob``; the actions,
arguments and failure reasons are the same here. All other actions on workspaces belong to the artifact ``workspace``
(`jacaros.artifacts.env.environment`).
"""

from collections.abc import Callable, Mapping
from functools import cache
from types import MappingProxyType
from typing import Final

from jacaros.agents.body.call import Call, failed, name_of, of_operation, succeeded, undelivered
from jacaros.agents.body.presence import AgentPresence
from jacaros.agents.body.values import to_value
from jacaros.agents.mind.state.act import Completion
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import NIL, Reference, Term, Var, bare, is_list
from jacaros.artifacts.env.errors import ArtifactId, OperationFailed
from jacaros.artifacts.env.operation import OperationOutcome
from jacaros.artifacts.env.ports import OnOutcome, UnderWay, Workspace
from jacaros.artifacts.env.values import Structure
from jacaros.artifacts.presence.joined import Filter, filter_of

Outputs = tuple[tuple[Term, Term], ...]
"""Values for output variables of an action."""

Finish = Callable[[Completion], None]
"""Called once with the outcome of an action."""


Action = Callable[[AgentPresence, Call, Finish], UnderWay | None]
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


def _give(presence: AgentPresence, call: Call, holder: ArtifactId, index: int, value: object) -> Outputs:
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


def _name(call: Call, index: int, holder: ArtifactId, what: str = "a name (a string or an atom)") -> str:
    """Return the name in an argument."""
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
    name, type_name = _name(call, 0, holder), _name(call, 1, holder, "the name of a type")
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
    name = _name(call, 0, presence.focused.body_in(here))
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
        workspace = presence.workspaces.find(_name(call, 0, session), intention)
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
            _name(call, 0, session), call.act.intention
        )
    presence.quit(workspace)
    finish(succeeded())


@_action("quitFromEnvironment", 0)
def quit_from_environment(presence: AgentPresence, call: Call, finish: Finish) -> None:
    """``quitFromEnvironment``: leave all workspaces; ``joinWorkspace`` returns."""
    for workspace in reversed(presence.workspaces.joined()):
        presence.quit(workspace)
    finish(succeeded())
