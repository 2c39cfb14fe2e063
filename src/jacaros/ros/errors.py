"""Errors of the middleware port, the same on every backend."""

from jacaros.errors import JacarosError


class RosError(JacarosError):
    """Something is wrong between the agent system and the robot's middleware."""


class BackendUnavailable(RosError):
    """The library of a backend is not installed; the text names it and the command that cures it."""


class NameInvalid(RosError):
    """A node, topic, service or type name breaks the naming rules of ROS."""


class UnknownInterface(RosError):
    """A message or service type is not known to the backend."""


class MessageMismatch(RosError):
    """A message does not fit its definition.

    Attributes:
        type_name: the type whose definition was broken, such as ``geometry_msgs/msg/Twist``.
        field: path of the field from the message's root, such as ``linear.x``; empty for the whole message.
        known: the fields that the type has.
    """

    def __init__(self, text: str, type_name: str = "", field: str = "", known: tuple[str, ...] = ()) -> None:
        super().__init__(text)
        self.type_name = type_name
        self.field = field
        self.known = known


class ServiceError(RosError):
    """A service call had no result; the parent of the three reasons below."""


class ServiceUnavailable(ServiceError):
    """Nobody offered the service until the time-out."""


class CallTimedOut(ServiceError):
    """The service is there but did not answer in time."""


class CallFailed(ServiceError):
    """The server reported a failure, or the connection to it broke during the call."""


class ServerGone(CallFailed):
    """The server of a service went away during the call; whether it was done is not known."""


class ServerUnavailable(ServiceUnavailable):
    """Nobody offered the action until the time-out."""


class ServerLost(ServiceError):
    """The action server went away while a goal was under way; whether the robot went on is not known."""


class GoalRejected(ServiceError):
    """The action server refused the goal; the text says why where the server did."""


class ParameterError(RosError):
    """Something is wrong with a parameter; the parent of the reasons below."""


class ParameterUnknown(ParameterError):
    """The node has no such parameter."""


class ParameterRefused(ParameterError):
    """The node, or the declaration of the parameter, refuses the value."""


class TransformUnavailable(RosError):
    """No transform between two frames is known for that time; the text says what is known.

    Attributes:
        reason: ``unknown_frame``, ``not_connected``, ``too_old`` or ``too_new``.
    """

    def __init__(self, text: str, reason: str = "unknown_frame") -> None:
        super().__init__(text)
        self.reason = reason


class CapabilityMissing(RosError):
    """The backend cannot do this, on principle or not yet; the text says which backends can."""
