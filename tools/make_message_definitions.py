"""Write ``robots/ros/interfaces/jazzy.msg``: the message types of ROS 2 Jazzy, from the typestore of rosbags.

    python tools/make_message_definitions.py

The file has the form in which ROS concatenates definitions. It holds types, names and constants, and no comments.
"""

import sys
from pathlib import Path
from typing import Any

from rosbags.typesys import Stores, get_typestore

FILE = Path(__file__).parents[1] / "src" / "jacaros" / "robots" / "ros" / "interfaces" / "jazzy.msg"
HEAD = """\
# Message definitions of ROS 2 Jazzy, without comments; tools/make_message_definitions.py writes this file.
# Licence: BSD-3-Clause for tf2_msgs and unique_identifier_msgs, Apache-2.0 for all others.
# Copyright: Open Source Robotics Foundation, Willow Garage and others.
"""
SEPARATOR = "=" * 80
FILLER = "structure_needs_at_least_one_member"
"""The field that ROS 2 adds to empty messages."""


def written() -> str:
    """Return the text of the file."""
    definitions = get_typestore(Stores.ROS2_JAZZY).fielddefs
    return HEAD + "".join(
        f"{SEPARATOR}\nMSG: {name}\n{_body(*definitions[name])}" for name in sorted(definitions)
    )


def _body(constants: list[Any], fields: list[Any]) -> str:
    lines = [f"{kind} {name}={value}" for name, kind, value in constants]
    lines += [f"{_type(kind)} {name}" for name, kind in fields if name != FILLER]
    return "".join(f"{line}\n" for line in lines)


def _type(description: Any) -> str:
    """Write the nested tuples of the typestore as a definition does."""
    node, content = description
    if node.name == "BASE":
        base, bound = content
        return f"{base}<={bound}" if bound else str(base)
    if node.name == "NAME":
        return str(content).replace("/msg/", "/")
    element, length = content
    bound = "<=" if length and node.name == "SEQUENCE" else ""
    return f"{_type(element)}[{bound}{length or ''}]"


if __name__ == "__main__":
    text = written()
    FILE.write_text(text, encoding="utf-8")
    sys.stdout.write(f"{FILE}: {text.count('MSG: ')} types, {len(text)} bytes\n")
