"""Errors of the middleware port, the same for every backend."""

from jacaros.runtime.errors import JacarosError


class RosError(JacarosError):
    """Parent of all errors at the border between the agent system and the robot's middleware."""


class BackendUnavailable(RosError):
    """Raised when the library of a backend is not installed; the text names it and the command that installs it."""


class NameInvalid(RosError):
    """Raised when a node, topic, service or type name breaks the naming rules of ROS."""


class UnknownInterface(RosError):
    """Raised when a message or service type is unknown to the backend."""


class MessageMismatch(RosError):
    """Raised when a message does not match its type definition.

    Attributes:
        type_name: the type, such as ``geometry_msgs/msg/Twist``.
        field: path of the field from the message's root, such as ``linear.x``; empty for the whole message.
        known: the fields of the type.
    """

    def __init__(self, text: str, type_name: str = "", field: str = "", known: tuple[str, ...] = ()) -> None:
        super().__init__(text)
        self.type_name = type_name
        self.field = field
        self.known = known


class ServiceError(RosError):
    """Raised when a service call has no result; parent of the three reasons below."""


class ServiceUnavailable(ServiceError):
    """Raised when no node offered the service before the time-out."""


class CallTimedOut(ServiceError):
    """Raised when the service exists but did not answer in time."""


class CallFailed(ServiceError):
    """Raised when the server reports a failure, or the connection to it breaks during the call."""


class ServerGone(CallFailed):
    """Raised when the server of a service disappears during the call; it is unknown whether the call was executed."""


class ServerUnavailable(ServiceUnavailable):
    """Raised when no server offered the action before the time-out."""


class ServerLost(ServiceError):
    """Raised when the action server disappears during a goal; it is unknown whether the robot continues."""


class GoalRejected(ServiceError):
    """Raised when the action server rejects the goal; the text gives the reason if the server does."""


class ParameterError(RosError):
    """Parent of the errors about parameters."""


class ParameterUnknown(ParameterError):
    """Raised when the node has no such parameter."""


class ParameterRefused(ParameterError):
    """Raised when the node, or the declaration of the parameter, refuses the value."""


class TransformUnavailable(RosError):
    """Raised when no transform between two frames is known for a time; the text says what is known.

    Attributes:
        reason: ``unknown_frame``, ``not_connected``, ``too_old`` or ``too_new``.
    """

    def __init__(self, text: str, reason: str = "unknown_frame") -> None:
        super().__init__(text)
        self.reason = reason


class CapabilityMissing(RosError):
    """Raised when the backend cannot do something; the text says which backends can."""
