"""Read ``parameters``: of other nodes, and of our own."""

import dataclasses

from jacaros.artifacts.mapping.declared import FieldPart, ParameterPart
from jacaros.artifacts.mapping.decoding import Unshowable
from jacaros.artifacts.mapping.parameters import parameter_converter
from jacaros.artifacts.mapping.paths import WHOLE
from jacaros.artifacts.mapping.read_fields import place_of, read_fields
from jacaros.artifacts.mapping.read_names import belief_name, ros_name
from jacaros.artifacts.mapping.read_operations import constant
from jacaros.artifacts.mapping.read_topics import positive, read_policy
from jacaros.files.yaml import Node
from jacaros.ros.errors import ParameterRefused
from jacaros.ros.parameter import Declaration, ParameterValue
from jacaros.ros.parameter_store import checked_value, fault_of

_SHOWN = ("parameter", "fields", "dead_band", "description")
OTHER = ("node", *_SHOWN, "rate")
OWN = ("default", *_SHOWN, "minimum", "maximum", "read_only")


def read_parameter(name: Node, node: Node) -> ParameterPart:
    """Read a property from a parameter, of another node or of our own."""
    if not isinstance(node.value, dict):
        # Short for {default: ...}.
        return ParameterPart(belief_name(name), place_of(name), "", str(name.value), _declaration(node, {}))
    own = not {"node", "rate"} & {str(key) for key in node.value}
    entries = node.mapping(*(OWN if own else OTHER), required=() if own else ("node",))
    if own and "default" not in entries:
        node.wrong(
            f"the parameter `{name.value}` has neither a node nor a default",
            "write the node that has it, node: controller_server, or its value if it is our own, default: 0.5",
        )
    field = _field(entries["fields"]) if "fields" in entries else None
    declaration = _declaration(entries["default"], entries) if "default" in entries else None
    if field is not None and declaration is not None:
        _require_shown(entries["default"], field, declaration.default)
    shown = (field,) if field is not None else None
    policy = read_policy({key: value for key, value in entries.items() if key != "rate"}, shown)
    policy = dataclasses.replace(policy, finite=True)  # no field has a replacement
    rate = entries.get("rate")
    return ParameterPart(
        belief_name(name),
        place_of(name),
        ros_name(entries["node"]).text if "node" in entries else "",
        entries["parameter"].text() if "parameter" in entries else str(name.value),
        declaration,
        field,
        positive(rate) if rate is not None else 1.0,
        policy,
        entries["description"].text() if "description" in entries else "",
    )


def _field(node: Node) -> FieldPart | None:
    """Read the conversion of the value."""
    fields = read_fields(node)
    if len(fields) != 1 or fields[0].path.steps:
        node.wrong("a parameter has one value and no fields", "write fields: {path: ., unit: degrees}")
        return None
    kind = fields[0].conversion.kind
    if kind not in ("", "atom") or fields[0].shares is not None or fields[0].otherwise is not None:
        told = "`otherwise`" if fields[0].otherwise is not None else f"`as: {kind}`" if kind else "`sample`"
        node.wrong(
            f"{told} is for messages", "a parameter can have: as: atom, names, unit, scale, offset, round"
        )
    return dataclasses.replace(fields[0], path=WHOLE)


def _require_shown(node: Node, field: FieldPart, default: ParameterValue) -> None:
    """Check the default of a parameter of our own: as it keeps its type, its conversion works for every value."""
    unnamed = dataclasses.replace(field.conversion, names=())  # other values may have no names
    try:
        parameter_converter(unnamed, node.what.strip("'"))([""] if default == [] else default)
    except Unshowable as wrong:
        node.wrong(str(wrong), wrong.help)


def _declaration(node: Node, entries: dict[str, Node]) -> Declaration:
    """Read the declaration of a parameter of our own; *node* is its default."""
    default = _value(node)
    limits = {key: entries[key].number() for key in ("minimum", "maximum") if key in entries}
    if limits and (isinstance(default, bool) or not isinstance(default, int | float)):
        entries[next(iter(limits))].wrong(
            f"only numbers have a range, but the default is {default!r}", "leave minimum and maximum out"
        )
        limits = {}
    declaration = Declaration(
        default,
        entries["description"].text() if "description" in entries else "",
        entries["read_only"].truth() if "read_only" in entries else False,
        limits.get("minimum"),
        limits.get("maximum"),
    )
    if (fault := fault_of(default, declaration)) is not None:
        node.wrong(
            f"the default is outside its range: it is {fault}", "write another default, or another range"
        )
    return declaration


def _value(node: Node) -> ParameterValue:
    if node.value is None:
        node.wrong("the parameter has no default", "write a number, true or false, a text, or a list of them")
        return 0
    try:
        return checked_value(constant(node))
    except ParameterRefused as refused:
        node.wrong(str(refused), "write numbers of one type in a list: [1.0, 2.5]")
        return 0
