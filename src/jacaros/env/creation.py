"""Create artifacts: find the type, connect object and kernel, and report why creation failed."""

from collections.abc import Callable

from jacaros.env.artifact import Artifact, Host
from jacaros.env.errors import InvalidArtifact, OperationFailed, UnknownArtifactType
from jacaros.env.ids import ArtifactId
from jacaros.env.kernel.changed_copies import changed_copies
from jacaros.env.kernel.declaration import NOTHING, DeclaredOperation
from jacaros.env.kernel.faults import error_text, is_interruption
from jacaros.env.kernel.interface import interface_of
from jacaros.env.kernel.setting import Setting
from jacaros.env.kernel.steps import Steps
from jacaros.env.operation import OperationRequest
from jacaros.env.values import Structure
from jacaros.errors import InternalError

FindType = Callable[[str], type[Artifact]]
"""Finds the class for a type name. Raises `UnknownArtifactType`."""


def refused(why: str, what: str, message: str) -> OperationFailed:
    """Return the failure with reason ``makeArtifactFailure(why, what)``."""
    return OperationFailed(message, Structure("makeArtifactFailure", (why, what)))


def init_failed(artifact_id: ArtifactId, message: str) -> OperationFailed:
    """Return the failure of an artifact whose ``init`` failed with *message*."""
    what = f"cannot create artifact {artifact_id.name} ({artifact_id.type_name})"
    return refused("init_failed", artifact_id.name, f"{what}: {message}")


def artifact_type_of(
    type_name: str | type[Artifact], find_type: FindType, setting: Setting
) -> type[Artifact]:
    """Return the class for *type_name*.

    Raises:
        OperationFailed: the type is unknown, or its module raises an error.
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
            setting.log(f"[{name}] cannot load the artifact type: {error}")
        else:
            setting.log_error(name, "cannot load the artifact type:", error)
        message = f"cannot load artifact type {name}: {error_text(error)}"
        raise refused("unknown_artifact_template", name, message) from error
    if not (isinstance(found, type) and issubclass(found, Artifact)):
        raise refused("unknown_artifact_template", name, f"{name} is not a subclass of Artifact")
    return found


def attach(artifact_type: type[Artifact], artifact_id: ArtifactId, host: Host, setting: Setting) -> Steps:
    """Create the object of an artifact and connect it with the kernel, which runs its operations.

    Raises:
        OperationFailed: its constructor failed.
    """
    try:
        artifact = artifact_type()
    except BaseException as error:
        if is_interruption(error):
            raise
        setting.log_error(artifact_id.name, f"the constructor of {artifact_type.__qualname__} failed:", error)
        raise init_failed(artifact_id, error_text(error)) from error
    if artifact_type not in setting.told:
        setting.told.add(artifact_type)
        _log_mistakes(artifact_type, setting)
    steps = Steps(artifact_id, artifact, artifact_type.interface, tuple(artifact_type.ports), setting)
    artifact._join(steps, host)
    return steps


def _log_mistakes(artifact_type: type[Artifact], setting: Setting) -> None:
    """Log mistakes that show in a class when its first artifact is created: its module is complete then."""
    for call in changed_copies(artifact_type):
        setting.log(
            f"[{artifact_type.__name__}] in {call} changes only a copy of the value: keep it in a variable, change the "
            "variable, and pass it to self.update_property"
        )
    if not any(artifact_type.interface.unknown_annotations()):
        return
    artifact_type.interface = interface_of(artifact_type)
    for operation, parameter, written in artifact_type.interface.unknown_annotations():
        setting.log(
            f"[{artifact_type.__name__}] parameter {parameter} of {operation} accepts any value: unknown annotation "
            f"{written!r}; correct it, or import it outside of `if TYPE_CHECKING`"
        )


def init_of(artifact_type: type[Artifact], request: OperationRequest) -> DeclaredOperation:
    """Return the ``init`` of *artifact_type* for the arguments of *request*.

    Without arguments, a type whose ``init`` requires some is created without calling it, as in CArtAgO (conformance case
    ``creation/make_failures``).

    Raises:
        OperationFailed: no ``init`` takes this number of arguments.
    """
    count = len(request.arguments)
    inits = artifact_type.interface.inits
    found = inits.find("init", count)
    if found is not None:
        return found
    if not count:
        return NOTHING
    taken = " or ".join(f"({each.signature})" for each in inits) or "()"
    raise init_failed(request.artifact, f"expected {taken} as arguments of init, found {count} arguments")
