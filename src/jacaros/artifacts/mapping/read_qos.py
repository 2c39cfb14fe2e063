"""Reads ``qos``: a profile, or what it consists of."""

from typing import cast

from jacaros.artifacts.mapping.read_fields import shown
from jacaros.ros.qos import DEFAULT_QOS, LATCHED, SENSOR_DATA, Durability, QoS, Reliability
from jacaros.yaml_nodes import Node

PROFILES = {"sensor_data": SENSOR_DATA, "default": DEFAULT_QOS, "latched": LATCHED}


_PARTS = {
    **{each: f"write qos: {{reliability: {each}}}" for each in ("reliable", "best_effort")},
    **{each: f"write qos: {{durability: {each}}}" for each in ("volatile", "transient_local")},
}
"""What to write for a part of a quality of service that stands alone."""


def read_qos(node: Node) -> QoS:
    """A quality of service; the default one after a mistake."""
    if not isinstance(node.value, dict):
        if node.value not in PROFILES:
            listed = f"write {', '.join(PROFILES)}, or {{reliability: ..., durability: ..., depth: ..., deadline: ...}}"
            node.wrong(f"there is no QoS profile {shown(node.value)}", _PARTS.get(str(node.value), listed))
        return PROFILES.get(node.value, DEFAULT_QOS)
    entries = node.mapping("reliability", "durability", "depth", "deadline")
    usual = DEFAULT_QOS
    deadline = entries["deadline"].number(0.0, default=1.0) if "deadline" in entries else None
    if deadline == 0.0:
        entries["deadline"].wrong("'deadline' is 0, but must be above zero", "write seconds")
        deadline = None
    return QoS(
        cast(Reliability, entries["reliability"].choice("reliable", "best_effort"))
        if "reliability" in entries
        else usual.reliability,
        cast(Durability, entries["durability"].choice("volatile", "transient_local"))
        if "durability" in entries
        else usual.durability,
        entries["depth"].whole(1, usual.depth) if "depth" in entries else usual.depth,
        deadline,
    )
