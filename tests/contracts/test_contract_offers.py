"""Contract: what agents offer, as actions, topics and services of the graph."""

import json
from collections.abc import Iterator
from typing import Any

import pytest

from jacaros.robots.ros.errors import GoalRejected

pytestmark = pytest.mark.needs("actions")
ACHIEVE = "jacaros_interfaces/action/Achieve"
PROGRAM = """
{ offer(goal, deliver(parcel(string), room([kitchen, office])), when_busy(wait)) }
{ offer(goal, count(n(number(0, 10)), m(out(number)))) }
{ offer(goal, guard, at_most(any)) }
{ offer(goal, repair, role(mechanic)) }
{ offer(belief, battery(level(number))) }
{ offer(question, double(x(number), y(out(number)))) }
{ offer(tell, closed(room(atom))) }
battery(80).
double(X, 2*X).
+!deliver(_, R) : closed(R) <- .refuse(closed(R)).
+!deliver(_, R) <- !drive(R); .progress(0.5, "half"); .wait(300); -+battery(70).
+!drive(_) <- .wait(300).
+!count(N, N+1).
@g[cleanup(tidy)] +!guard <- .wait(100000).
+!tidy <- .wait(50); .print(tidied).
+!repair.
+!secret.
"""


@pytest.fixture
def bob(graph: Any, left: Any, right: Any, own_name: str) -> Iterator[str]:
    """An agent of the right peer, whose actions the left one has found."""
    name = own_name[5:]
    right.offer(name, PROGRAM)
    actions = [f"/{name}/{goal}" for goal in ("deliver", "count", "guard", "achieve")]
    for action in actions:
        graph.wait_until(lambda a=action: left.action_ready(a, ACHIEVE), "the action is found")
    yield name
    # Behind a bridge to ROS 1, forty actions that are no longer needed make the others slow.
    right.close_door(name)
    for action in actions:
        left.close_action_client(action, ACHIEVE)


def asked(peer: Any, action: str, goal: str, **arguments: Any) -> Any:
    """Give a goal, and return its end."""
    peer.send_goal(action, action, {"goal": goal}, timeout=60, type_name=ACHIEVE, **arguments)
    return peer.outcome(action, timeout=60)


def test_an_offered_goal_is_an_action(graph, left, bob):
    end = asked(left, f"/{bob}/deliver", '{"parcel": "p1", "room": "kitchen"}')
    assert (end["status"], end["result"]["state"], end["result"]["reasons"]) == ("succeeded", "achieved", [])
    graph.wait_until(lambda: left.told(f"/{bob}/deliver"), "feedback arrives")
    assert {"doing": "drive(kitchen)", "progress": -1.0, "note": ""} in left.told(f"/{bob}/deliver")
    half = {"doing": 'deliver("p1",kitchen)', "progress": 0.5, "note": "half"}
    graph.wait_until(lambda: half in left.told(f"/{bob}/deliver"), "the progress arrives")


def test_results_are_bindings(left, bob):
    end = asked(left, f"/{bob}/count", "[3]")
    assert (end["status"], json.loads(end["result"]["results"])) == ("succeeded", {"m": 4})


def test_one_action_takes_all_goals_as_text(left, bob):
    assert json.loads(asked(left, f"/{bob}/achieve", "count(4, M)")["result"]["results"]) == {"m": 5}
    assert asked(left, f"/{bob}/deliver", 'deliver("p", office)')["status"] == "succeeded"


@pytest.mark.parametrize(
    ("goal", "code"),
    [
        ("secret", "not_offered"),
        ("repair", "not_permitted"),
        ("deliver(p1, cellar)", "invalid_arguments"),
        ("count(11, M)", "invalid_arguments"),
        ("count(", "invalid_arguments"),
        ("", "invalid_arguments"),
        ("count(" + "[" * 3000 + ")", "too_large"),
    ],
)
def test_a_wrong_request_has_no_effect_and_says_why(left, bob, goal, code):
    end = asked(left, f"/{bob}/achieve", goal)
    assert (end["status"], end["result"]["state"]) == ("aborted", code)
    assert end["result"]["message"]


@pytest.mark.parametrize("goal", ["{", "[1, 2]", '{"n": "x"}', '{"n": NaN}', "[" * 100000, "drive(kitchen)"])
def test_wrong_arguments_have_no_effect(left, bob, goal):
    end = asked(left, f"/{bob}/count", goal)
    assert (end["status"], end["result"]["state"]) == ("aborted", "invalid_arguments")


def test_a_refusal_has_its_reason(graph, left, bob):
    told = left.call(f"/{bob}/tell", {"belief": "closed(kitchen)"}, 60, "jacaros_interfaces/srv/Tell")
    assert told["success"]
    end = asked(left, f"/{bob}/deliver", '["p1", "kitchen"]')
    assert (end["status"], end["result"]["state"]) == ("aborted", "refused")
    assert end["result"]["reasons"][0] == "refused(closed(kitchen))"
    assert end["result"]["message"] == "closed(kitchen)"


def test_cancelling_waits_for_the_clean_up(graph, left, right, bob):
    action = f"/{bob}/guard"
    left.send_goal(action, action, {}, timeout=60, type_name=ACHIEVE)
    graph.wait_until(lambda: left.told(action), "the goal is under way")
    before = right.printed().count("tidied")
    assert left.cancel_goal(action, timeout=60)
    end = left.outcome(action, timeout=60)
    assert (end["status"], end["result"]["state"]) == ("canceled", "cancelled")
    assert right.printed().count("tidied") == before + 1


def test_beliefs_are_latched_topics(graph, left, bob):
    topic = f"/{bob}/battery"
    left.subscribe(topic, "std_msgs/msg/String", durability="transient_local", depth=1)
    graph.wait_until(lambda: left.received(topic), "the belief arrives")
    assert json.loads(left.received(topic)[0]["data"]) == [{"level": 80}]
    asked(left, f"/{bob}/deliver", '["p1", "kitchen"]')
    graph.wait_until(lambda: '[{"level": 70}]' in str(left.received(topic)), "the new one arrives")


def test_services_answer_questions(left, bob):
    ask, why = "jacaros_interfaces/srv/Ask", "jacaros_interfaces/srv/Why"
    answer = left.call(f"/{bob}/ask", {"question": "double(4, Y)"}, 60, ask)
    assert (answer["success"], json.loads(answer["answers"])) == (True, [{"Y": 8}])
    refused = left.call(f"/{bob}/ask", {"question": "secret(X)"}, 60, ask)
    assert (refused["success"], refused["message"].split(":")[0]) == (False, "not_offered")
    asked(left, f"/{bob}/count", "[3]")
    told = left.call(f"/{bob}/why", {"question": "why !count(3, _)"}, 60, why)
    assert "asked by ros:" in told["explanation"]


@pytest.mark.only("ros1")
def test_ros_1_says_which_node_asks(left, right, bob):
    asked(left, f"/{bob}/count", "[3]")
    assert right.callers(bob) == ["ros:/left"]


@pytest.mark.needs("refusing goals")
def test_goals_are_rejected_while_the_agents_are_not_active(left, right, bob):
    right.activate(bob, False)
    with pytest.raises(GoalRejected):
        asked(left, f"/{bob}/count", "[3]")
    right.activate(bob, True)
    assert asked(left, f"/{bob}/count", "[3]")["status"] == "succeeded"


def test_a_closed_door_ends_the_goals_of_its_clients(graph, left, right, bob):
    action = f"/{bob}/guard"
    left.send_goal(action, action, {}, timeout=60, type_name=ACHIEVE)
    graph.wait_until(lambda: left.told(action), "the goal is under way")
    right.close_door(bob)
    assert left.outcome(action, timeout=60)["status"] == "aborted"


@pytest.mark.only("memory", "ros1", "ros2")
@pytest.mark.parametrize("left_how", ["close", "kill"])
def test_a_goal_whose_only_client_has_left_is_cancelled(graph, left, right, own_name, left_how):
    name = f"{own_name[5:]}_{left_how}"
    program = "{ offer(goal, guard, when_left(cancel)) } +!guard <- .print(begun); .wait(100000). "
    right.offer(
        name, program + "^!guard[state(dropped)] <- .print(NAME, dropped).".replace("NAME", f'"{name}"')
    )
    client, action = graph.peer(f"leaving_{left_how}"), f"/{name}/guard"
    graph.wait_until(lambda: client.action_ready(action, ACHIEVE), "the action is found")
    client.send_goal(action, action, {}, timeout=60, type_name=ACHIEVE)
    graph.wait_until(lambda: client.told(action), "the goal is under way")
    if left_how == "kill":
        graph.kill(client)
    else:
        client.close_action_client(action, ACHIEVE)
    graph.wait_until(lambda: f"{name}dropped" in right.printed(), "the goal is dropped")


MAPPED = """
offers:
  go:
    type: {type}
    action: {name}
    goal:
      x: {path}.pose.position.x
      y: {path}.pose.position.y
      yaw: {{path: {path}.pose.orientation, as: yaw, unit: degrees, round: 1}}
  level:
    type: sensor_msgs/msg/BatteryState
    fields: {{percentage: {{value: $percent, unit: percent}}}}
"""
GOING = """
{ offer(goal, go(x(number), y(number), yaw(number))) }
{ offer(belief, level(percent(number))) }
level(50).
+!go(X, Y, Yaw) : X > 10 <- .refuse(too_far).
+!go(X, Y, Yaw) <- .print(X, " ", Y, " ", Yaw).
"""


def test_a_mapping_file_names_the_types(graph, left, right, own_name):
    name = own_name[5:]
    type_name, path = ("nav2_msgs/action/NavigateToPose", "pose")
    right.offer(name, GOING, MAPPED.format(type=type_name, name=f"/{name}/navigate", path=path))
    action = f"/{name}/navigate"
    graph.wait_until(lambda: left.action_ready(action, type_name), "the action is found")

    def go(x: float) -> Any:
        pose = {"position": {"x": x, "y": 2.0}, "orientation": {"z": 1.0, "w": 0.0}}
        left.send_goal(action, action, {"pose": {"pose": pose}}, timeout=60, type_name=type_name)
        return left.outcome(action, timeout=60)

    assert go(1.5)["status"] == "succeeded"
    assert "1.5 2 180" in right.printed()
    far = go(11.0)
    assert (far["status"], far["text"]) == ("aborted", "too_far")
    topic = f"/{name}/level"
    left.subscribe(topic, "sensor_msgs/msg/BatteryState", durability="transient_local", depth=1)
    graph.wait_until(lambda: left.received(topic), "the belief arrives")
    assert left.received(topic)[0]["percentage"] == 0.5
