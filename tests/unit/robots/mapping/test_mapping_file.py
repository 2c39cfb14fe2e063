"""Mapping files: reading them, and mistakes that are found without message types."""

import subprocess
import sys
from pathlib import Path

import pytest
from mapped_lab import mistakes

from jacaros.robots.mapping.file import MappingError, MappingFile, find_mapping, load_mapping, read_mapping
from jacaros.robots.ros.qos import LATCHED, SENSOR_DATA, QoS
from jacaros.runtime.mas.checks.observables import Observables
from jacaros.runtime.mas.mappings import check_mapping_file


def told(text: str) -> list[str]:
    """The problems of a file: `line:column: message | help`."""
    with pytest.raises(MappingError) as caught:
        read_mapping(text, "m.yaml")
    return [f"{p.line}:{p.column}: {p.message} | {p.help}" for p in caught.value.problems]


def properties(text: str) -> MappingFile:
    return read_mapping(f"properties:\n{text}", "m.yaml")


def test_a_file_without_artifacts_is_one_that_is_called_like_it() -> None:
    mapping = read_mapping("properties: {chatter: chatter}", "talker.yaml")
    [part] = mapping.artifacts.values()
    assert part.name == "talker"
    [chatter] = part.properties
    assert chatter.topic is not None
    assert (chatter.name, chatter.topic.text) == ("chatter", "chatter")
    assert (chatter.type_name, chatter.fields) == (None, None)


def test_several_artifacts_keep_their_order() -> None:
    mapping = read_mapping("artifacts:\n  b: {namespace: /r1/}\n  a: {tf_prefix: x, connected: 2}")
    assert list(mapping.artifacts) == ["b", "a"]
    assert mapping.artifacts["b"].namespace == "r1"
    assert (mapping.artifacts["a"].tf_prefix, mapping.artifacts["a"].connected) == ("x", 2.0)


@pytest.mark.parametrize(
    ("written", "qos"),
    [
        ("sensor_data", SENSOR_DATA),
        ("latched", LATCHED),
        ("{depth: 3}", QoS(depth=3)),
        ("{reliability: best_effort, deadline: 0.5}", QoS("best_effort", deadline=0.5)),
    ],
)
def test_qos_is_a_profile_or_its_parts(written: str, qos: QoS) -> None:
    [part] = properties(f"  a: {{topic: a, qos: {written}}}").artifacts["m"].properties
    assert part.qos == qos


def test_policies_of_a_property() -> None:
    text = "  a: {topic: a, fields: [x, y], rate: 5, dead_band: [1, 2], expire: 3, latest_only: false}"
    [part] = properties(text).artifacts["m"].properties
    policy = part.policy
    assert (policy.rate, policy.dead_band, policy.expire, policy.latest_only) == (5.0, (1.0, 2.0), 3.0, False)


WRONG = r"""
a: [b
  1:4: this bracket is never closed | close the bracket
properties: {a: {topic: t, fields: [x[0]]}}
  1:38: not YAML: a bracket within a text of a list | write a text with brackets in quotes: "ranges[0]"
- a
  1:1: a mapping file must be a mapping of keys to values |
propertys: {}
  1:1: a mapping file has no key 'propertys' | did you mean `properties`?
properties: {a: {rate: 1}}
  1:17: 'a' lacks the key 'topic' | add 'topic: ...'
properties:\n  a: t\n  a: u
  3:3: duplicate key 'a', first in line 2 | rename one of them, or remove it
properties: {a: t}\nsignals: {a: u}
  2:11: the signal `a` has the same name as the property on line 1 | give it another name
properties: {Pose: t}
  1:14: 'Pose' is not a valid name in agent programs | write pose
properties: {a: 'my topic'}
  1:17: 'my topic' is not a ROS name | write it like cmd_vel or /robot/cmd_vel
namespace: 'a b'
  1:12: 'a b' is not a ROS namespace | write it like r1 or fleet/r1
properties: {a: {topic: t, type: Odometry}}
  1:34: 'Odometry' is not a type of messages | write it like nav_msgs/msg/Odometry
properties: {a: {topic: t, type: std_srvs/srv/Trigger}}
  1:34: std_srvs/srv/Trigger is the type of a service, not of messages | write a type such as nav_msgs/msg/Odometry
operations: {a: {action: t, type: nav_msgs/msg/Odometry}}
  1:35: nav_msgs/msg/Odometry is the type of messages, not of an action | write a type such as nav2_msgs/action/
frames: {a: {target: map, source: b, fields: [{path: x, unit: degrees}]}}
  1:47: x of a transform is a length, but degrees is a unit of angle | units of length are metres,
frames: {a: {target: map, source: b, fields: [{path: yaw, as: yaw}]}}
  1:47: yaw of a transform is a number | it can only have a unit, scale, offset and round
frames: {a: {target: map, source: ''}}
  1:35: `source` is empty | write the name of a frame, such as base_link
tf_prefix: [a]\nproperties: {a: t}
  1:12: 'tf_prefix' must be a text
artifacts: {a b: {properties: {c: t}}}
  1:13: 'a b' is not a name for an artifact | write a word
properties: {a: {topic: t, type: nav_msgs.msg.Odometry}}
  1:34: 'nav_msgs.msg.Odometry' is not a type of messages | write nav_msgs/msg/Odometry
properties: {a: {topic: t, type: 'nav_msgs::msg::Odometry'}}
  1:34: 'nav_msgs::msg::Odometry' is not a type of messages | write nav_msgs/msg/Odometry
properties:\n  odom:\n    topic: odom\n  type: nav_msgs/msg/Odometry\n
  4:3: `type` is used like the name of a property | indent it, below the name that it belongs to
properties:\n  odom:\n    topic: odom\n  rate: 5\n
  4:3: `rate` is used like the name of a property | indent it
signals:\n  bump:\n    topic: bump\n  fields: [data]\n
  4:3: `fields` is used like the name of a signal | indent it
operations:\n  go:\n    publish: t\n  parameters: [x]\n
  4:3: `parameters` is used like the name of an operation | indent it
properties:\n  a:\n    topic:odom\n
  3:5: 'topic:odom' is not a ROS name | write a space after the colon: topic: odom
properties: {a: {topic: t, fields: {x: pose.x, y: pose.y}}}
  1:36: 'fields' has no `path`, and `x` is not a key | write a list of paths, or of mappings such as
properties: {a: {topic: t, qos: reliable}}
  1:33: unknown QoS profile 'reliable' | write qos: {reliability: reliable}
properties: {a: {topic: t, rate: 0}}
  1:34: 'rate' is 0, but must be above zero | leave 'rate' out, or write a number
connected: yes\nproperties: {a: t}
  1:12: `connected` must be true, false, or a number of seconds above zero | write true
artifacts: {a: {}}\nproperties: {b: t}
  2:1: `properties` is on the same level as `artifacts` | indent it, below the name of an artifact
operations: {say: {parameters: [words], publish: t, fields: {data: words}}}
  1:68: `words` is a text here, not the parameter | write $words
properties: {a: {topic: t, fields: ['pose..x']}}
  1:37: `pose..x` is not a path: `` is not a field | write it like pose.position.x or ranges[0]
properties: {a: {topic: t, fields: {path: x, unit: meters}}}
  1:52: unknown unit 'meters' | did you mean `metres`? Units: radians, degrees, metres, centimetres, millimetres,
  metres_per_second, kilometres_per_hour, seconds, milliseconds, minutes, celsius, kelvin, share, percent
properties: {a: {topic: t, fields: {path: q, as: yaw, unit: percent}}}
  1:61: `as: yaw` makes an angle, but percent is a unit of share | units of angle are radians, degrees
properties: {a: {topic: t, fields: {path: q, as: jaw}}}
  1:50: 'as' is 'jaw' | choose one of: yaw, pitch, roll, name, atom, object, count, min, max, mean
properties: {a: {topic: t, fields: {path: x, scale: 0}}}
  1:53: `scale` is 0, which removes the value | write another number
properties: {a: {topic: t, fields: {path: x, sample: [0, 2]}}}
  1:58: item 2 of 'sample' is 2, but must lie between 0 and 1 |
properties: {a: {topic: t, fields: [x, y], dead_band: [1]}}
  1:55: `dead_band` has 1 numbers, but the property has 2 values | write one number for all, or one for each value
properties: {a: {topic: t, mode: lazy}}
  1:34: 'mode' is 'lazy' | choose one of: verbose, on_demand
properties: {a: {topic: t, mode: on_demand}}
  1:14: no operation requests `a`, which is updated on demand | add an operation: look: {refresh: a}
properties: {a: {topic: t, each: x, expire: 2}}
  1:45: the properties of elements are those of the newest message | leave `expire` out, or `each`
properties: {a: {topic: t, fields: ['x[i]']}}
  1:37: `x[i]` needs `each` | without `each` write the path alone
properties: {a: {topic: t, qos: fast}}
  1:33: unknown QoS profile 'fast' | write sensor_data, default, latched, or {reliability: ..., durability: ...,
  depth: ..., deadline: ...}
frames: {a: {target: map}}
  1:13: 'a' lacks the key 'source' | add 'source: ...'
frames: {a: {target: map, source: s, fields: [x, w]}}
  1:50: a transform has no `w` | it has x, y, z, roll, pitch, yaw, stamp
operations: {go: {topic: t}}
  1:14: the operation `go` does not name what it does | write one of publish, service, action, set_parameter,
  refresh
operations: {go: {parameters: [a]}}
  1:14: the operation `go` does not name what it does | write one of publish, service, action, set_parameter,
  refresh
operations: {go: {servise: t}}
  1:14: the operation `go` does not name what it does | did you mean `service`?
operations: {go: {publish: t, service: s}}
  1:14: the operation `go` has publish and service | write one of publish, service, action, set_parameter,
  refresh
operations: {go: {publish: t, request: {}}}
  1:31: 'go' has no key 'request' | known keys: publish, parameters, description, uses, expect, meanwhile, type, fields,
  qos, rate, duration
operations: {go: {service: s, expect: {within: 2, else: late}}}
  1:39: 'expect' names no property | write a property with its values: docked: [true]
operations: {go: {service: s, expect: {docked: true}}}
  1:48: 'docked' must be a list | write '- item' lines or [item, item]
operations: {go: {service: s, expect: {docked: [true], within: -1}}}
  1:64: 'within' is -1, but must be at least 0
operations: {go: {service: s, expect: {docked: [true], else: "Not docked"}}}
  1:62: 'Not docked' is not a valid name in agent programs | write not_docked
operations: {go: {service: s, expect: [{docked: [true]}, {no: {bump: [_]}}]}}
  1:64: `no` is about signals while the operation runs | write it below `meanwhile`
operations: {go: {service: s, parameters: [x], request: {a: $x}, expect: {pose: [{near: $y, by: 1}]}}}
  1:82: the operation has no parameter `y` | parameters: $x
operations: {go: {service: s, meanwhile: {pose: [{nera: 2, by: 1}]}}}
  1:50: invalid pattern | write a constant, _, $parameter, {not: X}, {in: [X, Y]} or {near: X, by: 20, unit: degrees}
properties: {p: {topic: t, type: std_msgs/msg/Bool, fields: [data]}}\noperations: {go: {service: s, expect: {p: [_, 2]}}}
  2:40: `p` has 1 value, not 2 | write a pattern for each value, _ for any
properties: {p: {topic: t, mode: on_demand}}\noperations: {look: {refresh: p}, go: {service: s, expect: {p: [_]}}}
  2:60: `p` is updated on demand, so it shows no effect | expect another property, or leave out its `mode`
operations: {go: {parameters: [speed], publish: t, fields: {x: $sped}}}
  1:64: the operation has no parameter `sped` | did you mean `$speed`?
operations: {go: {publish: t, fields: {x: $v}}}
  1:43: the operation has no parameter `v` | add it to `parameters`: [v]
operations: {go: {parameters: [v, v], publish: t}}
  1:35: duplicate parameter `v` | rename one of them
operations: {go: {publish: t, rate: 3}}
  1:37: `rate` needs `duration` | write seconds: duration: 2, or duration: $seconds
operations: {go: {publish: t, duration: 3}}
  1:41: `duration` needs `rate` | write messages per second: rate: 10
operations: {go: {publish: t, fields: {linear: {x: 1}}}}
  1:48: `linear` has no fields of its own here | write their paths: linear.x: ...
operations: {go: {publish: t, fields: {x: {value: 1, as: mean}}}}
  1:58: `as: mean` is for fields that an agent reads | here: yaw, pitch, roll, name
operations: {go: {action: a, suspend: pause}}
  1:39: 'suspend' is 'pause' | choose one of: cancel, go_on
operations: {look: {refresh: pose}}
  1:30: unknown property `pose` | properties from topics and frames: none
parameters: {a: 1, b: {default: 2, parameter: c}}\noperations: {go: {set_parameter: b, value: 1}}
  2:34: `go` names no node, and `b` is not a parameter of our own | our own parameters: a, c
parameters: {a: {minimum: 1}}
  1:17: 'a' lacks the key 'default' | add 'default: ...'
parameters: {a: }
  1:14: the parameter has no default | write a number, true or false, a text, or a list of them
parameters: {a: [1, 2.5]}
  1:17: expected a bool, a number, a text, bytes, or a list of bools, ints, floats or texts, found [1, 2.5] | write
  numbers of one type in a list: [1.0, 2.5]
parameters: {a: {default: b, minimum: 1}}
  1:39: only numbers have a range, but the default is 'b' | leave minimum and maximum out
parameters: {a: {default: 3, maximum: 2}}
  1:27: the default is outside its range: it is at most 2, not 3 | write another default, or another range
parameters: {a: {default: fast, fields: {path: ., unit: degrees}}}
  1:27: parameter `default`: expected a number, found "fast" | leave out its unit, scale, offset and round
parameters: {a: {default: fast, fields: {path: ., names: {fast: swift}, round: 1}}}
  1:27: parameter `default`: expected a number, found "fast" | leave out its unit, scale, offset and round
parameters: {a: {default: [], fields: {path: ., unit: degrees}}}
  1:27: parameter `default`: expected a number, found "" | leave out its unit, scale, offset and round
parameters: {a: {default: 3.0, fields: {path: ., otherwise: 0}}}
  1:40: `otherwise` is for messages | a parameter can have: as: atom, names, unit, scale, offset, round
parameters: {a: {default: 3, fields: {path: ., as: yaw}}}
  1:38: `as: yaw` is for messages | a parameter can have: as: atom, names, unit, scale, offset, round
operations: {a: {service: s, success: {path: stalled}}}
  1:39: `success` is incomplete | write {path: code, is: 0}, or {path: stalled, else: nothing_grasped}
artifacts: {}
  1:12: no artifacts | write the name of one below `artifacts`
"""


@pytest.mark.parametrize(("text", "expected"), mistakes(WRONG).items())
def test_a_mistake_is_reported_with_location_and_help_and_types_are_checked_too(
    text: str, expected: str, tmp_path: Path
) -> None:
    found = told(text)
    assert any(each.startswith(expected) for each in found), found
    (tmp_path / "m.yaml").write_text(text, encoding="utf-8")
    assert check_mapping_file(tmp_path / "m.yaml", Observables())


def test_an_empty_file_is_reported() -> None:
    assert told("") == ["1:1: the file is empty | begin with properties: or operations:"]


def test_properties_and_constants_may_be_called_like_keys_and_parameters() -> None:
    parts = properties("  mode: mode\n  rate: {topic: rate}").artifacts["m"].properties
    assert [part.name for part in parts] == ["mode", "rate"]
    fields = "{header.frame_id: map, data: $map}"
    read_mapping(f"operations: {{go: {{parameters: [map], publish: t, fields: {fields}}}}}\n")


def test_all_mistakes_are_reported_in_one_pass_in_the_order_of_the_lines() -> None:
    found = told("properties:\n  A: t\n  b: {topic: t, mode: lazy}\noperations:\n  go: {}\n")
    assert [each.split(":")[0] for each in found] == ["2", "3", "5"]


def test_a_mistake_is_shown_with_its_line() -> None:
    with pytest.raises(MappingError) as caught:
        read_mapping("properties:\n  pose: {topic: odom, unit: 3}\n", "m.yaml")
    assert str(caught.value).startswith(
        "m.yaml:2:23: error: 'pose' has no key 'unit'\n"
        "    2 |   pose: {topic: odom, unit: 3}\n"
        "                              ^\n"
        "  = help: known keys: topic, type, frame, fields, "
    )


@pytest.mark.parametrize("value", ["true", "false", "{}"])
def test_a_pattern_that_is_not_in_a_list_is_reported_once(value: str) -> None:
    own = "properties: {p: {topic: t, type: std_msgs/msg/Bool, fields: [data]}}"
    found = told(f"{own}\noperations: {{go: {{service: s, expect: {{p: {value}}}}}}}")
    assert found == ["2:43: 'p' must be a list | write '- item' lines or [item, item]"]


def test_a_file_that_is_not_there_or_not_text(tmp_path: Path) -> None:
    assert find_mapping("no.yaml", (tmp_path,)) is None
    with pytest.raises(MappingError, match="mapping file not found"):
        load_mapping(tmp_path / "no.yaml")
    (tmp_path / "m.yaml").write_bytes(b"\xff\xfe")
    with pytest.raises(MappingError, match="the file is in UTF-16"):
        load_mapping(tmp_path / "m.yaml")


def test_reading_a_mapping_loads_neither_artifacts_nor_a_middleware() -> None:
    script = "import sys, jacaros.robots.mapping.file; print(*sys.modules)"
    output = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout
    loaded = [name for name in output.split() if name.startswith("jacaros")]
    assert len(loaded) <= 21, loaded
    assert not [name for name in loaded if name.startswith(("jacaros.artifacts", "jacaros.runtime.clock"))]
