"""Big things by reference: what an agent passes on and never looks into."""

from typing import Any


class MessageHandle:
    """An image, a cloud, a map: a message, or a part of one, that crosses to agents as an opaque reference.

    Internal actions and operations in Python get the handle itself and read `value`; nothing is copied on the way.

    Attributes:
        value: the message or array, as the middleware gave it; read-only by agreement.
        type_name: of the message, or of what it holds: ``sensor_msgs/msg/Image``, ``uint8[]``.
    """

    __slots__ = ("type_name", "value")

    def __init__(self, value: Any, type_name: str) -> None:
        self.value, self.type_name = value, type_name

    def __repr__(self) -> str:
        return f"<{self.type_name}>"
