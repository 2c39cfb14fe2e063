"""Names of nodes, topics and types."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from jacaros.robots.ros.errors import NameInvalid
from jacaros.robots.ros.names import NodeNames, message_type, near_names, service_type

segments = st.builds(str.__add__, st.sampled_from("abZ_"), st.text("abZ_09", max_size=6))


@pytest.mark.parametrize(
    ("written", "full"),
    [
        ("nav_msgs/Odometry", "nav_msgs/msg/Odometry"),
        ("nav_msgs/msg/Odometry", "nav_msgs/msg/Odometry"),
        ("a1/B_c", "a1/msg/B_c"),
    ],
)
def test_message_types_have_one_full_form(written: str, full: str) -> None:
    assert message_type(written) == full
    assert service_type(written.replace("msg/", "srv/")) == full.replace("/msg/", "/srv/")


@pytest.mark.parametrize("written", ["", "Odometry", "a/b/c/d", "a//b", "a/mesg/b", "1a/B", "a/B c", "/a/B"])
def test_an_invalid_type_name_is_refused(written: str) -> None:
    with pytest.raises(NameInvalid, match="not a type name"):
        message_type(written)


@pytest.mark.parametrize("name", ["", "a/b", "1a", "a b", "~a"])
def test_an_invalid_node_name_is_refused(name: str) -> None:
    with pytest.raises(NameInvalid, match="not a node name"):
        NodeNames(name)


@pytest.mark.parametrize("name", ["", "/", "a//b", "a/", "/a b", "/1", "~", "{x}", "a-b"])
def test_an_invalid_topic_name_is_refused(name: str) -> None:
    with pytest.raises(NameInvalid):
        NodeNames("node").resolve(name)


@pytest.mark.parametrize("namespace", ["r1", "/r1", "r1/", "/r1/"])
def test_a_namespace_may_be_written_with_or_without_slashes(namespace: str) -> None:
    names = NodeNames("brain", namespace)
    assert (names.namespace, names.full_name, names.resolve("odom")) == ("/r1", "/r1/brain", "/r1/odom")


def test_remapping_replaces_whole_names_once() -> None:
    names = NodeNames("n", "r", {"a": "b", "b": "c", "/x": "~y"})
    assert names.resolve("a") == "/r/b"
    assert names.resolve("/r/a") == "/r/b"
    assert names.resolve("/r/b") == "/r/c"
    assert names.resolve("/x") == "/r/n/y"
    assert names.resolve("a2") == "/r/a2"


@given(st.lists(segments, min_size=1, max_size=4), segments, st.lists(segments, max_size=3))
def test_resolving_twice_changes_nothing(name: list[str], node: str, namespace: list[str]) -> None:
    names = NodeNames(node, "/".join(namespace))
    absolute = names.resolve("/".join(name))
    assert names.resolve(absolute) == absolute
    assert absolute == "".join(f"/{part}" for part in [*namespace, *name])


def test_a_name_of_the_same_type_is_suggested_before_one_of_a_similar_spelling() -> None:
    known = ["/odometry", "/camera/info", "/base/wheels", "/robot_1/odom"]
    assert near_names("/odom", known) == ["/robot_1/odom", "/odometry"]
    assert near_names("/odom", known, alike=["/base/wheels"]) == ["/base/wheels"]
    assert near_names("/odom", known, alike=["/base/wheels", "/robot_1/odom"]) == ["/robot_1/odom"]
    assert near_names("/nothing", known) == []
