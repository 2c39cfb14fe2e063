"""The ``topics``, ``services`` and ``actions`` of a robot in a world file.

A name of the simulator with another name renames it, or adds it to a robot whose kind lacks it. A new name with a type adds
a topic or a service::

    topics:
      scan: front/scan                                        # below the namespace; /front/scan: not
      temperature: {type: sensor_msgs/msg/Temperature, message: {temperature: 21.5}, rate: 1}    # published
      horn: {type: std_msgs/msg/Bool, receive: true}          # subscribed to
    services:
      reset: {type: std_srvs/srv/Trigger, response: {success: true}}
    actions:
      navigate_to_pose: go_to
"""

import re
from collections.abc import Mapping
from typing import Any

from jacaros.files.texts import suggestion
from jacaros.files.yaml import Node
from jacaros.sim.interface import ACTIONS, SERVICES, TOPICS, Interface, OwnService, OwnTopic

SECTIONS = ("topics", "services", "actions")
_KNOWN: Mapping[str, tuple[str, ...]] = {"topics": TOPICS, "services": SERVICES, "actions": ACTIONS}
_TYPES: Mapping[str, str] = {"topics": "msg", "services": "srv"}
_NAME = re.compile(r"/?[A-Za-z][A-Za-z0-9_]*(/[A-Za-z][A-Za-z0-9_]*)*")
_FASTEST = 20.0
"""Highest rate of an added topic, in messages per second: that of the world's ticks."""


def read_interface(entries: Mapping[str, Node], usual: Interface) -> Interface:
    """Read the names of one robot; *usual* are those of its kind."""
    renamed: dict[str, str] = {}
    topics: list[OwnTopic] = []
    services: list[OwnService] = []
    for section in SECTIONS:
        given = list(entries[section].entries()) if section in entries else []
        others = set(_KNOWN[section]) - usual.lacking - {key.value for key, _ in given}
        used = {name: name for name in others}
        for key, value in given:
            name = _name(key)
            if key.value in _KNOWN[section]:
                renamed[name] = offered = _name(value)
            elif section == "actions" or not isinstance(value.value, dict):
                _unknown(key, section)
                continue
            elif section == "topics":
                topics.append(_topic(offered := name, value))
            else:
                services.append(_service(offered := name, value))
            if offered in used:
                value.wrong(
                    f"`{offered}` is also the name of `{used[offered]}`", "give one of them another name"
                )
            used[offered] = name
    return Interface(usual.lacking, renamed, tuple(topics), tuple(services))


def _name(node: Node) -> str:
    text = node.text()
    if text and not _NAME.fullmatch(text):
        node.wrong(
            f"'{text}' is not a ROS name", "use letters, digits and _, with / between parts: front/scan"
        )
    return text


def _unknown(key: Node, section: str) -> None:
    other = f"known names: {', '.join(_KNOWN[section])}"
    if section in _TYPES:
        other = f"to add it, give its type: `{key.value}: {{type: PACKAGE/{_TYPES[section]}/TYPE}}`"
    key.wrong(
        f"unknown name in '{section}': `{key.value}`", suggestion(str(key.value), _KNOWN[section], other)
    )


def _type(node: Node | None, kind: str) -> str:
    text = node.text() if node is not None else ""
    if node is not None and text and not re.fullmatch(rf"[a-z]\w*/{kind}/[A-Z]\w*", text):
        node.wrong(f"'{text}' is not a type", f"write it as PACKAGE/{kind}/TYPE")
    return text


def _fields(node: Node | None) -> dict[str, Any]:
    return {str(name.value): value.value for name, value in node.entries()} if node is not None else {}


def _topic(name: str, node: Node) -> OwnTopic:
    entries = node.mapping("type", "message", "rate", "receive", required=("type",))
    type_name = _type(entries.get("type"), "msg")
    if "receive" in entries and entries["receive"].truth():
        for key in ("message", "rate"):
            if key in entries:
                entries[key].wrong(
                    f"a topic that is received has no '{key}'", f"remove '{key}', or 'receive'"
                )
        return OwnTopic(name, type_name, rate=0.0)
    rate = entries["rate"].number(0.01, _FASTEST, 1.0) if "rate" in entries else 1.0
    return OwnTopic(name, type_name, _fields(entries.get("message")), rate)


def _service(name: str, node: Node) -> OwnService:
    entries = node.mapping("type", "response", required=("type",))
    return OwnService(name, _type(entries.get("type"), "srv"), _fields(entries.get("response")))
