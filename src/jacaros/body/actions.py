"""What an agent does with workspaces and artifacts as such: make, look up, focus, join …

CArtAgO has artifacts for these actions, one body per agent and workspace among them; here the agent's own
body does them, with the same names, arguments and reasons of failure.
"""

from collections.abc import Callable
from dataclasses import dataclass

from jacaros.bdi.act import Completion
from jacaros.body.call import Call, artifact_argument, name_argument, workspace_argument
from jacaros.body.completion import of_operation, refused, succeeded
from jacaros.body.focus import FocusedArtifacts
from jacaros.body.selection import Selection
from jacaros.body.values import References, to_value
from jacaros.body.whereabouts import Whereabouts
from jacaros.env.errors import OperationFailed
from jacaros.env.ids import ArtifactId, resolve_path
from jacaros.env.operation import OperationOutcome
from jacaros.env.ports import Environment, Told, UnderWay, Workspace
from jacaros.env.values import Structure
from jacaros.terms.text import text
from jacaros.terms.unifier import equal
from jacaros.terms.values import NIL, String, Term, Var, bare, is_list, make_list

Finish = Callable[[Completion], None]
"""To be told how an action ended, once."""


@dataclass(frozen=True, slots=True)
class Situation:
    """An agent amid its environment.

    Attributes:
        agent: its name.
        environment: all there is.
        whereabouts: its workspaces.
        focused: its focused artifacts.
        selection: how it finds artifacts.
        references: opaque references of the run.
        joined: told of every workspace that it joins (True) or quits (False).
    """

    agent: str
    environment: Environment
    whereabouts: Whereabouts
    focused: FocusedArtifacts
    selection: Selection
    references: References
    joined: Callable[[Workspace, bool], None]


Action = Callable[[Situation, Call, Finish], UnderWay | None]
"""Carries out a call; gives a handle on what is still under way.

Raises OperationFailed when it cannot be done."""

ACTIONS: dict[tuple[str, int], Action] = {}
"""The actions by name and number of arguments."""


def _action(name: str, *arities: int) -> Callable[[Action], Action]:
    def register(action: Action) -> Action:
        ACTIONS.update({(name, arity): action for arity in arities})
        return action

    return register


def keys() -> list[str]:
    """Names with numbers of arguments, such as ``focus/1``."""
    return [f"{name}/{arity}" for name, arity in ACTIONS]


def _give(call: Call, index: int, value: Term) -> tuple[tuple[Term, Term], ...]:
    """The output *value* for an argument of a call, if the call has so many.

    Raises:
        OperationFailed: the argument has another value already.
    """
    if index >= len(call.arguments):
        return ()
    argument = call.arguments[index]
    if argument.__class__ is Var:
        return ((argument, value),)
    if equal(argument, value):
        return ()
    raise OperationFailed(
        f"argument {index + 1} of {call.key} is an output and would be {text(value)}, "
        f"but is {text(argument)} already",
        Structure("bind_param_error", (call.key,)),
    )


def _place(situation: Situation, call: Call, path: str) -> tuple[Workspace, str]:
    """The workspace and the plain name meant by the name or path of an artifact."""
    current = situation.whereabouts.current(call.act.intention)
    if "/" not in path:
        return current, path
    above, _, name = resolve_path(current.path, path).rpartition("/")
    return situation.environment.workspace(above), name


def _artifact(situation: Situation, call: Call, index: int = 0) -> ArtifactId:
    """The artifact that an argument means: an id, or a name in the workspaces of the agent."""
    wanted = artifact_argument(call.arguments[index], call.name)
    places = tuple(situation.whereabouts.in_order(call.act.intention))
    return situation.selection.artifact(wanted, places)


def _workspace_of(situation: Situation, artifact: ArtifactId) -> Workspace:
    return situation.environment.workspace(artifact.workspace)


def _told(situation: Situation, finish: Finish) -> Told:
    """Let an action end as what was asked of a workspace ended."""
    return lambda outcome: finish(of_operation(outcome, [], situation.references))


@_action("makeArtifact", 2, 3, 4)
def make_artifact(situation: Situation, call: Call, finish: Finish) -> UnderWay | None:
    """``makeArtifact(Name, Type [, Parameters] [, -Id])``: make an artifact in the current workspace."""
    arguments = call.arguments
    workspace, name = _place(situation, call, name_argument(arguments[0], call.name))
    type_name = name_argument(arguments[1], call.name)
    only_id = len(arguments) == 3 and arguments[2].__class__ is Var
    parameters = bare(arguments[2]) if len(arguments) > 2 and not only_id else NIL
    if not is_list(parameters):
        raise OperationFailed(
            f"the third argument of makeArtifact is a list of parameters, not {text(parameters)}",
            Structure("wrong_op_arguments", (call.key,)),
        )

    def made(artifact: ArtifactId | None, outcome: OperationOutcome) -> None:
        try:
            if artifact is None:
                raise OperationFailed(outcome.message or "", outcome.reason)
            output = _give(call, 2 if only_id else 3, situation.references.of(artifact))
        except OperationFailed as failure:
            finish(refused(failure, situation.references))
        else:
            finish(succeeded(*output))

    return workspace.create(name, type_name, to_value(parameters), situation.agent, made)


@_action("lookupArtifact", 2)
def lookup_artifact(situation: Situation, call: Call, finish: Finish) -> None:
    """``lookupArtifact(Name, -Id)``: an artifact of the current workspace, or the one at a path."""
    workspace, name = _place(situation, call, name_argument(call.arguments[0], call.name))
    finish(succeeded(*_give(call, 1, situation.references.of(workspace.lookup(name)))))


@_action("lookupArtifactByType", 2)
def lookup_artifact_by_type(situation: Situation, call: Call, finish: Finish) -> None:
    """``lookupArtifactByType(Type, -Id)``: the oldest artifact of a type in the current workspace."""
    wanted = name_argument(call.arguments[0], call.name)
    workspace = situation.whereabouts.current(call.act.intention)
    for artifact in workspace.artifacts():
        if artifact.type_name == wanted or artifact.type_name.rpartition(".")[2] == wanted:
            finish(succeeded(*_give(call, 1, situation.references.of(artifact))))
            return
    raise OperationFailed(
        f"workspace {workspace.path} has no artifact of type {wanted}",
        Structure("artifact_not_available", (wanted,)),
    )


@_action("getCurrentArtifacts", 1)
def get_current_artifacts(situation: Situation, call: Call, finish: Finish) -> None:
    """``getCurrentArtifacts(-Names)``: the artifacts of the current workspace, as strings."""
    workspace = situation.whereabouts.current(call.act.intention)
    names = make_list([String(artifact.name) for artifact in workspace.artifacts()])
    finish(succeeded(*_give(call, 0, names)))


@_action("disposeArtifact", 1)
def dispose_artifact(situation: Situation, call: Call, finish: Finish) -> None:
    """``disposeArtifact(Id)``: end an artifact."""
    artifact = _artifact(situation, call)
    _workspace_of(situation, artifact).dispose_artifact(artifact, _told(situation, finish))


@_action("linkArtifacts", 3)
def link_artifacts(situation: Situation, call: Call, finish: Finish) -> None:
    """``linkArtifacts(FromId, Port, ToId)``: put an artifact behind an out port of another one."""
    source, target = _artifact(situation, call), _artifact(situation, call, 2)
    port = name_argument(call.arguments[1], call.name)
    _workspace_of(situation, source).link(source, port, target, _told(situation, finish))


@_action("focus", 1)
def focus(situation: Situation, call: Call, finish: Finish) -> None:
    """``focus(Id)``: perceive an artifact from now on; its name will do as well."""
    artifact = _artifact(situation, call)
    workspace = _workspace_of(situation, artifact)
    situation.focused.begin(workspace, artifact, call.namespace, _told(situation, finish))


class _Waiting:
    """Waits for an artifact that is not there yet."""

    def __init__(self, stop: Callable[[], None]) -> None:
        self._stop = stop

    def cancel(self) -> None:
        self._stop()

    def pause(self) -> None:
        """Nothing: waiting does no harm."""

    def resume(self) -> None:
        """Nothing."""


@_action("focusWhenAvailable", 1)
def focus_when_available(situation: Situation, call: Call, finish: Finish) -> UnderWay | None:
    """``focusWhenAvailable(Name)``: wait until the current workspace has it, and focus it."""
    workspace, wanted = _place(situation, call, name_argument(call.arguments[0], call.name))
    present = next((a for a in workspace.artifacts() if a.name == wanted), None)
    if present is not None:
        situation.focused.begin(workspace, present, call.namespace, _told(situation, finish))
        return None

    def look(artifact: ArtifactId, is_there: bool) -> None:
        if is_there and artifact.name == wanted:
            stop()
            situation.focused.begin(workspace, artifact, call.namespace, _told(situation, finish))

    stop = workspace.watch(look)
    return _Waiting(stop)


@_action("stopFocus", 1)
def stop_focus(situation: Situation, call: Call, finish: Finish) -> None:
    """``stopFocus(Id)``: perceive an artifact no more; without effect when it is not focused."""
    wanted = artifact_argument(call.arguments[0], call.name)
    if isinstance(wanted, str):
        wanted = _artifact(situation, call)
    situation.focused.end(wanted, call.namespace)
    finish(succeeded())


@_action("createWorkspace", 1)
def create_workspace(situation: Situation, call: Call, finish: Finish) -> None:
    """``createWorkspace(Path)``: make a workspace; the path starts from the current one."""
    current = situation.whereabouts.current(call.act.intention)
    path = resolve_path(current.path, name_argument(call.arguments[0], call.name))
    situation.environment.create_workspace(path)
    finish(succeeded())


@_action("joinWorkspace", 1, 2)
def join_workspace(situation: Situation, call: Call, finish: Finish) -> None:
    """``joinWorkspace(Path [, -Id])``: make a workspace the current one of the intention."""
    intention = call.act.intention
    wanted = workspace_argument(call.arguments[0], call.name)
    workspace = situation.whereabouts.find(wanted, intention) if isinstance(wanted, str) else wanted
    output = _give(call, 1, situation.references.of(workspace))
    if situation.whereabouts.join(workspace, intention):
        situation.joined(workspace, True)
    finish(succeeded(*output))


@_action("quitWorkspace", 0, 1)
def quit_workspace(situation: Situation, call: Call, finish: Finish) -> None:
    """``quitWorkspace(Id)``: leave a workspace (without argument the current one) and all focused there."""
    intention = call.act.intention
    workspace = situation.whereabouts.current(intention)
    if call.arguments:
        wanted = workspace_argument(call.arguments[0], call.name)
        workspace = situation.whereabouts.named(wanted, intention) if isinstance(wanted, str) else wanted
    situation.focused.end_all(workspace)
    if situation.whereabouts.quit(workspace):
        situation.joined(workspace, False)
    finish(succeeded())
