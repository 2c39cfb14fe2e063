"""Messages with large arrays as CBOR: which types, and how arrays look in it.

A subscription may ask the server for CBOR (RFC 8949) in place of JSON.  Arrays of numbers are octets then, in typed arrays
(RFC 8746), so that images and scans cost a fraction; and infinite numbers and NaN arrive as they are.  Servers cannot pack
every type: at arrays of a fixed length, for instance, they lose the message.
"""

from typing import Any

from jacaros.ros.fields import FieldType
from jacaros.ros.typestore import RosbagsSchema

_LITTLE = {
    64: "u1",
    68: "u1",
    69: "<u2",
    70: "<u4",
    71: "<u8",
    72: "i1",
    77: "<i2",
    78: "<i4",
    79: "<i8",
    84: "<f2",
    85: "<f4",
    86: "<f8",
}
_BIG = {65: ">u2", 66: ">u4", 67: ">u8", 73: ">i2", 74: ">i4", 75: ">i8", 80: ">f2", 81: ">f4", 82: ">f8"}
_ARRAYS = _LITTLE | _BIG
"""Tags of typed arrays, and their elements as numpy writes them."""


def worth_packing(schema: RosbagsSchema, type_name: str) -> bool:
    """Whether CBOR pays for a type, and servers can write all of its fields."""
    fields = list(_all_fields(schema, type_name, set()))
    return all(_can_be_packed(field) for field in fields) and any(
        field.array and field.is_numeric for field in fields
    )


def _all_fields(schema: RosbagsSchema, type_name: str, seen: set[str]) -> list[FieldType]:
    if type_name in seen:
        return []
    seen.add(type_name)
    fields = list(schema.fields(type_name).values())
    return fields + [
        inner for field in fields if field.is_message for inner in _all_fields(schema, field.base, seen)
    ]


def _can_be_packed(field: FieldType) -> bool:
    if field.base == "byte":
        return False
    return not field.array or (not field.length and field.base != "string")


def unpacked(value: Any) -> Any:
    """Give a typed array as numpy's; None when *value* is none that is known."""
    kind = _ARRAYS.get(getattr(value, "tag", -1))
    if kind is None or not isinstance(value.value, bytes):
        return None
    import numpy  # here: many systems have no array at all

    return numpy.frombuffer(value.value, dtype=kind)
