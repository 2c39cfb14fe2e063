"""Contract: parameters."""

from typing import Any

import pytest

from jacaros.robots.ros.errors import CapabilityMissing, ParameterRefused, ParameterUnknown, ServiceError

pytestmark = pytest.mark.needs("parameters")


def having(peer: Any, name: str, value: Any) -> str:
    """Give *peer* a parameter, in the way of its middleware; gives the name that is right there."""
    if "declared parameters" in peer.capabilities():
        assert peer.declare(name, value) == value
    else:
        peer.set_parameter(name, value)
    return name


@pytest.fixture
def name(own_name: str) -> str:
    """The name of a parameter that belongs to this test."""
    return own_name


@pytest.mark.parametrize(
    ("kind", "first", "second"),
    [
        ("bool", True, False),
        ("int", 3, -4),
        ("float", 0.5, 1e-3),
        ("text", "schön", ""),
        ("ints", [1, 2], [3]),
        ("floats", [0.5, 1.5], [2.5]),
        ("texts", ["a", "b"], ["c"]),
        ("bools", [True, False], [True]),
    ],
)
def test_a_parameter_is_read_and_changed_by_others(graph, left, right, name, kind, first, second):
    having(right, f"{name}_{kind}", first)
    node = right.node_name()
    assert left.get_parameter(f"{name}_{kind}", node, timeout=60) == first
    left.set_parameter(f"{name}_{kind}", second, node, timeout=60)
    assert right.get_parameter(f"{name}_{kind}", timeout=60) == second
    assert type(left.get_parameter(f"{name}_{kind}", node, timeout=60)) is type(second)


@pytest.mark.needs("own parameters")
def test_a_node_reads_and_changes_its_own(graph, left, name):
    having(left, name, 1)
    left.set_parameter(name, 2, timeout=60)
    assert left.get_parameter(name, timeout=60) == 2
    assert left.parameter_node() == left.node_name()


@pytest.mark.needs("own parameters")
def test_names_are_reported(graph, left, right, name):
    for ending in ("b", "a"):
        having(right, f"{name}_{ending}", 1)
    names = left.parameter_names(right.node_name(), timeout=60)
    assert [n for n in names if n.startswith(name)] == [f"{name}_a", f"{name}_b"]
    assert f"{name}_a" not in left.parameter_names(timeout=60)


@pytest.mark.needs("own parameters")
def test_an_unknown_parameter_is_reported(graph, left, right, name):
    with pytest.raises(ParameterUnknown, match=f"{right.node_name()}.*{name}"):
        left.get_parameter(name, right.node_name(), timeout=60)
    with pytest.raises(ParameterUnknown, match=name):
        left.get_parameter(name, timeout=60)


@pytest.mark.needs("own parameters")
def test_a_parameter_that_was_not_declared_cannot_be_set(graph, left, right, name):
    if "declared parameters" in left.capabilities():
        with pytest.raises(ParameterUnknown, match=name):
            left.set_parameter(name, 1, right.node_name(), timeout=60)
    else:
        left.set_parameter(name, 1, right.node_name(), timeout=60)
        assert right.get_parameter(name, timeout=60) == 1


@pytest.mark.needs("own parameters")
def test_values_that_no_parameter_holds_are_refused(graph, left, name):
    having(left, name, 1)
    for value in (None, {"a": 1}, [1, "a"], [[1]]):
        with pytest.raises(ParameterRefused):
            left.set_parameter(name, value, timeout=60)
    assert left.get_parameter(name, timeout=60) == 1


def test_declaring_is_for_where_parameters_are_declared(graph, left, right, name):
    if "declared parameters" not in left.capabilities():
        with pytest.raises(CapabilityMissing, match="declare"):
            left.declare(name, 1)
        return
    assert left.declare(name, 1) == 1
    with pytest.raises(ParameterRefused, match="already declared"):
        left.declare(name, 2)
    with pytest.raises(CapabilityMissing, match="itself"):
        left.declare(name, 1, node=right.node_name())


def test_a_declaration_is_taken_back(graph, left, right, name):
    if "declared parameters" not in left.capabilities():
        with pytest.raises(CapabilityMissing, match="withdrawn"):
            left.withdraw(name)
        return
    with pytest.raises(ParameterUnknown, match=name):
        left.withdraw(name)
    with pytest.raises(CapabilityMissing, match="itself"):
        left.withdraw(name, node=right.node_name())
    left.declare(name, 1, read_only=True)
    left.withdraw(name)
    with pytest.raises(ParameterUnknown, match=name):
        right.get_parameter(name, left.node_name(), timeout=60)
    assert left.declare(name, "another type") == "another type"


def test_numbers_and_ranges_have_their_limits(graph, left, name):
    if "declared parameters" not in left.capabilities():
        return
    for default in (2**63, [2**63]):
        with pytest.raises(ParameterRefused, match="64 bits"):
            left.declare(name, default)
    assert left.declare(name, 1, minimum=-float("inf"), maximum=1e300) == 1
    left.set_parameter(name, 2**63 - 1, timeout=60)
    with pytest.raises(ParameterRefused, match="64 bits"):
        left.set_parameter(name, -(2**63) - 1, timeout=60)
    with pytest.raises(ParameterRefused):
        left.set_parameter(name, [], timeout=60)


@pytest.mark.parametrize(
    ("default", "rules", "accepted", "refused", "why"),
    [
        pytest.param(1, {}, [], ["one"], "", id="type"),
        pytest.param(0.5, {"minimum": 0.0, "maximum": 1.0}, [1.0], [1.5, -0.5], "", id="range"),
        pytest.param([], {}, [["a"]], [[1]], "", id="type of an empty list, alone one of texts"),
        pytest.param(5, {"minimum": 1}, [1_000_000], [0], "", id="open range"),
        pytest.param("fixed", {"read_only": True}, [], ["loose"], "read-only", id="read-only"),
    ],
)
def test_a_parameter_keeps_to_its_declaration(left, right, name, default, rules, accepted, refused, why):
    if "declared parameters" not in right.capabilities():
        with pytest.raises(CapabilityMissing, match="declare"):
            right.declare(name, default, **rules)
        return
    assert right.declare(name, default, **rules) == default
    node = right.node_name()
    for value in accepted:
        left.set_parameter(name, value, node, timeout=60)
    for value in refused:
        with pytest.raises(ParameterRefused, match=why or name):
            left.set_parameter(name, value, node, timeout=60)
        if "read_only" in rules:
            with pytest.raises(ParameterRefused, match=why):
                right.set_parameter(name, value, timeout=60)
    assert left.get_parameter(name, node, timeout=60) == [default, *accepted][-1]


def test_a_default_that_breaks_its_declaration_is_refused(graph, right, name):
    error = ParameterRefused if "declared parameters" in right.capabilities() else CapabilityMissing
    with pytest.raises(error):
        right.declare(name, 7, minimum=0, maximum=5)


@pytest.mark.needs("given parameters")
def test_given_values_take_the_place_of_defaults(graph, left, name):
    """Of a launch file: where parameters are declared they count when that is done, else they are there at once."""
    given = {f"{name}_a": 0.25, f"{name}_b": ["x", "y"], f"{name}_c": 1, f"{name}_d": 7, f"{name}_e": []}
    # Tried again, the test has a node of another name: parameters are asked for by it.
    tuned = graph.peer(f"tuned_{name}", parameters=given)
    node = graph.node_of(tuned)
    if "declared parameters" not in tuned.capabilities():
        # The master receives it in a thread.
        graph.wait_until(lambda: f"{name}_d" in left.parameter_names(node, timeout=20), "all are given")
        assert [left.get_parameter(each, node, timeout=20) for each in given] == [*given.values()]
        assert tuned.given_parameters_without_use() == []
        return
    assert f"{name}_a" not in tuned.parameter_names(timeout=20)
    assert tuned.declare(f"{name}_a", 0.5) == 0.25
    assert tuned.declare(f"{name}_b", ["z"], read_only=True) == ["x", "y"]
    assert tuned.declare(f"{name}_e", [1, 2]) == []
    with pytest.raises(ParameterRefused, match=r"of type float; 1 is of type int; write 1\.0"):
        tuned.declare(f"{name}_c", 0.5)
    with pytest.raises(ParameterRefused, match="from 0 to 5, not 7"):
        tuned.declare(f"{name}_d", 2, minimum=0, maximum=5)
    assert left.get_parameter(f"{name}_a", node, timeout=20) == 0.25
    assert left.get_parameter(f"{name}_b", node, timeout=20) == ["x", "y"]
    assert tuned.given_parameters_without_use() == []
    left.set_parameter(f"{name}_a", 0.75, node, timeout=20)
    tuned.withdraw(f"{name}_a")
    assert tuned.declare(f"{name}_a", 0.5) == 0.25


def test_changes_are_reported(graph, left, right, name):
    if "parameter events" not in left.capabilities():
        with pytest.raises(CapabilityMissing, match="change"):
            left.watch_parameters(name, right.node_name())
        return
    having(right, name, 1)
    left.watch_parameters(name, right.node_name())

    def told(value: int) -> bool:
        return {name: value} in left.parameter_changes(name)

    def change_is_told() -> bool:
        left.set_parameter(name, 2, right.node_name(), timeout=60)
        return told(2)

    graph.wait_until(change_is_told, "a change by another node is reported")
    right.set_parameter(name, 3, timeout=60)
    graph.wait_until(lambda: told(3), "a change by the node itself is reported")
    having(right, name + "_new", 7)
    graph.wait_until(lambda: {name + "_new": 7} in left.parameter_changes(name), "a declaration is reported")
    left.unwatch_parameters(name)
    before = len(left.parameter_changes(name))
    left.set_parameter(name, 4, right.node_name(), timeout=60)
    graph.pass_time(0.3)
    assert len(left.parameter_changes(name)) == before


@pytest.mark.needs("own parameters")
def test_only_the_changes_of_the_node_are_reported(graph, left, right, name):
    if "parameter events" not in left.capabilities():
        with pytest.raises(CapabilityMissing, match="change"):
            left.watch_parameters(name)
        return
    having(left, name, 1)
    having(right, name, 1)
    right.watch_parameters(name)

    def own_change_is_told() -> bool:
        left.set_parameter(name, 2, timeout=60)
        right.set_parameter(name, 5, timeout=60)
        return {name: 5} in right.parameter_changes(name)

    graph.wait_until(own_change_is_told, "its own change is reported")
    assert {name: 2} not in right.parameter_changes(name)


def test_a_node_that_is_not_there_cannot_be_asked(graph, left, name):
    if graph.kind.endswith("ros1"):  # the master keeps the parameters, whether there is such a node or not
        with pytest.raises(ParameterUnknown, match=name):
            left.get_parameter(name, "/nobody", timeout=60)
    else:
        with pytest.raises((ServiceError, ParameterUnknown), match="nobody"):
            left.get_parameter(name, "/nobody", timeout=0.5)
