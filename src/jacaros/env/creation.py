"""Making artifacts: finding the type, joining object and kernel, and the reasons why it can fail."""

from collections.abc import Callable

from jacaros.env.artifact import Artifact, Host
from jacaros.env.errors import InvalidArtifact, OperationFailed, UnknownArtifactType
from jacaros.env.ids import ArtifactId
from jacaros.env.kernel.changed_copies import changed_copies
from jacaros.env.kernel.declaration import DeclaredOperation, declare_method
from jacaros.env.kernel.faults import is_interruption, told
from jacaros.env.kernel.interface import interface_of
from jacaros.env.kernel.setting import Setting
from jacaros.env.kernel.steps import Steps
from jacaros.env.operation import INIT, Mark, OperationRequest
from jacaros.env.values import Structure
from jacaros.errors import InternalError

FindType = Callable[[str], type[Artifact]]
"""Finds the class for a type name; raises `UnknownArtifactType`."""


def refused(why: str, what: str, message: str) -> OperationFailed:
    """The failure with reason ``makeArtifactFailure(why, what)``."""
    return OperationFailed(message, Structure("makeArtifactFailure", (why, what)))


def init_failed(artifact_id: ArtifactId, message: str) -> OperationFailed:
    """The failure of an artifact whose ``init`` failed with *message*."""
    made = f"artifact {artifact_id.name} ({artifact_id.type_name}) cannot be made"
    return refused("init_failed", artifact_id.name, f"{made}: {message}")


def artifact_type_of(
    type_name: str | type[Artifact], find_type: FindType, setting: Setting
) -> type[Artifact]:
    """The class for *type_name*.

    Raises:
        OperationFailed: there is none, or it cannot be loaded.
    """
    if not isinstance(type_name, str):
        return type_name
    name = str.__str__(type_name)
    try:
        found = find_type(name)
    except UnknownArtifactType as unknown:
        raise refused("unknown_artifact_template", name, str(unknown)) from None
    except InternalError:
        raise
    except BaseException as error:
        if is_interruption(error):
            raise
        if isinstance(error, InvalidArtifact):
            setting.log(f"[{name}] the artifact type cannot be loaded: {error}")
        else:
            setting.log_error(name, "the artifact type cannot be loaded:", error)
        message = f"artifact type {name} cannot be loaded: {told(error)}"
        raise refused("unknown_artifact_template", name, message) from error
    if not (isinstance(found, type) and issubclass(found, Artifact)):
        raise refused("unknown_artifact_template", name, f"{name} is not a class derived from Artifact")
    return found


def attach(artifact_type: type[Artifact], artifact_id: ArtifactId, host: Host, setting: Setting) -> Steps:
    """Make the object of an artifact and join it with what runs its operations.

    Raises:
        OperationFailed: its constructor failed.
    """
    try:
        artifact = artifact_type()
    except BaseException as error:
        if is_interruption(error):
            raise
        setting.log_error(artifact_id.name, f"the constructor of {artifact_type.__qualname__} failed:", error)
        raise init_failed(artifact_id, told(error)) from error
    if artifact_type not in setting.told:
        setting.told.add(artifact_type)
        _tell_author(artifact_type, setting)
    steps = Steps(artifact_id, artifact, artifact_type.interface, tuple(artifact_type.ports), setting)
    artifact._join(steps, host)
    return steps


def _tell_author(artifact_type: type[Artifact], setting: Setting) -> None:
    """Tell of mistakes that can be seen in a class, when the first artifact of it is made: all its module is there then."""
    for call in changed_copies(artifact_type):
        setting.log(
            f"[{artifact_type.__name__}] in {call} changes a copy of the value, and nothing else: keep it in a variable, "
            "change that, and give it to self.update_property"
        )
    if not any(artifact_type.interface.unknown_annotations()):
        return
    artifact_type.interface = interface_of(artifact_type)
    for operation, parameter, written in artifact_type.interface.unknown_annotations():
        setting.log(
            f"[{artifact_type.__name__}] parameter {parameter} of {operation} accepts anything: its annotation "
            f"{written!r} is not known; correct it, or import it outside of `if TYPE_CHECKING`"
        )


def init_of(artifact_type: type[Artifact], request: OperationRequest) -> DeclaredOperation:
    """The ``init`` of *artifact_type* for the arguments of *request*.

    Without arguments, a type that has no ``init`` for that is made all the same, and nothing is done
    (case ``creation/make_failures``, as in CArtAgO).

    Raises:
        OperationFailed: none takes that number of arguments.
    """
    count = len(request.arguments)
    inits = artifact_type.interface.inits
    found = inits.find("init", count)
    if found is not None:
        return found
    if not count:
        return NO_INIT
    taken = " or ".join(f"({each.signature})" for each in inits) or "()"
    raise init_failed(request.artifact, f"its init takes {taken}, not {count} arguments")


def _nothing(_: Artifact) -> None:
    """Stand for the ``init`` of an artifact that is made without."""


NO_INIT = declare_method(Mark(INIT), "init", _nothing, Artifact, 0)
