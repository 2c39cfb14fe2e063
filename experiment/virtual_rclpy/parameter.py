"""``rclpy.parameter``: parameters of a node."""

from enum import IntEnum
from typing import Any, ClassVar

from virtual_rclpy.messages import Interface


class Parameter:
    """A parameter.

    Args:
        value: a boolean, number or string.
    """

    class Type(IntEnum):
        """The types that baselines use, as in ``rcl_interfaces/msg/ParameterType``."""

        BOOL = 1
        INTEGER = 2
        DOUBLE = 3
        STRING = 4
        BYTE_ARRAY = 5
        BOOL_ARRAY = 6
        INTEGER_ARRAY = 7
        DOUBLE_ARRAY = 8
        STRING_ARRAY = 9

    _TYPES: ClassVar = {bool: Type.BOOL, int: Type.INTEGER, float: Type.DOUBLE, str: Type.STRING}

    def __init__(self, value: Any) -> None:
        self.value = value

    @property
    def type_(self) -> Type:
        """The type of the value."""
        return self._TYPES[type(self.value)]

    def get_parameter_value(self) -> Any:
        """Return the ``rcl_interfaces/msg/ParameterValue``."""
        field = f"{self.type_.name.lower()}_value"
        return Interface("rcl_interfaces/msg/ParameterValue")(type=int(self.type_), **{field: self.value})
