"""People who walk through a world: their paths, what stops them, and how robots perceive them."""

import math

import pytest

from jacaros.robots.world import PersonDescription, World, WorldError, read_world
from jacaros.robots.world.data.ground_truth import RobotEvent
from jacaros.runtime.errors import UsageError

WORLD = """
name: flat
size: [10, 6]
border: walls
doors:
  - {name: gate, segment: [[4, -3], [4, 3]], open: true}
robots:
  - {name: a, pose: {x: 0, y: 0}}
people:
  - {name: ann, path: [[-2, 2], [2, 2]], speed: 1}
"""
ANN = "{name: ann, path: [[-2, 2], [2, 2]], speed: 1}"


def world(ann: str = ANN, *more: str) -> World:
    text = WORLD.replace(ANN, ann)
    return World.load(text + "".join(f"  - {each}\n" for each in more))


def told(world: World) -> list[RobotEvent]:
    return [event for event in world.log if event.kind.startswith("person_")]


def place(world: World, name: str = "ann") -> tuple[float, float]:
    person = world.people[name]
    return round(person.x, 6), round(person.y, 6)


def test_a_person_walks_to_the_end_of_its_path_and_stays_there() -> None:
    flat = world()
    assert place(flat) == (-2.0, 2.0)
    flat.run(1.0)
    assert place(flat) == (-1.0, 2.0)
    flat.run(9.0)
    assert place(flat) == (2.0, 2.0)
    assert [(event.kind, event.time, event.data.get("vx")) for event in told(flat)] == [
        ("person_walks", 0.02, 1.0),
        ("person_stands", 4.02, None),
    ]


def test_a_loop_never_ends_and_pauses_at_each_point() -> None:
    flat = world("{name: ann, path: [[-2, 2], [2, 2], [2, 1]], speed: 2, pause: 1, loop: true}")
    flat.run(2.5)
    assert place(flat) == (2.0, 2.0)
    flat.run(0.76)
    assert place(flat) == (2.0, 1.48)
    flat.run(3.3)
    x, y = place(flat)
    assert math.dist((x, y), (-2.0, 2.0)) < 0.05
    walks = [event.data for event in told(flat) if event.kind == "person_walks"]
    assert [(round(each["vx"], 2), round(each["vy"], 2)) for each in walks] == [
        (2, 0),
        (0, -2),
        (-1.94, 0.49),
    ]


def test_a_careful_person_stops_before_a_robot_and_continues_when_it_leaves() -> None:
    flat = world("{name: ann, path: [[-2, 0], [2, 0]]}")
    flat.run(5.0)
    gap = -flat.people["ann"].x - 0.17 - 0.25
    assert 0.27 < gap <= 0.3
    assert flat.people["ann"].waits_for == "a"
    assert told(flat)[-1].data["waits_for"] == "a"
    assert not [event for event in flat.log if event.kind == "collision"]
    flat.robot("a").y = 1.0
    flat.run(5.0)
    assert place(flat) == (2.0, 0.0)


def test_a_robot_beside_or_behind_does_not_stop_people() -> None:
    flat = world("{name: ann, path: [[-2, 0.5], [2, 0.5]]}")
    flat.run(4.5)
    assert place(flat) == (2.0, 0.5)
    behind = world("{name: ann, path: [[0.45, 0], [2, 0]]}")
    behind.run(2.0)
    assert place(behind) == (2.0, 0.0)


def test_a_careless_person_runs_into_a_robot_but_not_through_it() -> None:
    flat = world("{name: ann, path: [[-2, 0], [2, 0]], careless: true}")
    flat.run(5.0)
    (bump,) = [event for event in flat.log if event.kind == "collision"]
    assert (bump.robot, bump.data) == ("a", {"with": "ann", "side": "back"})
    robot, ann = flat.robot("a"), flat.people["ann"]
    assert robot.x - ann.x == pytest.approx(0.42, abs=0.001)
    assert robot.x < 0.03, "it is nudged, not pushed along"
    assert robot.touching == {"ann"}


def test_a_person_blocks_a_robot() -> None:
    flat = world("{name: ann, path: [[1, 0]]}")
    for _ in range(50):
        flat.command("a", 0.5, 0.0)
        flat.run(0.1)
    robot = flat.robot("a")
    assert robot.x == pytest.approx(0.58, abs=0.001)
    assert place(flat) == (1.0, 0.0)
    assert robot.contacts == {"ann": "front"}
    assert [event.data for event in flat.log if event.kind == "collision"] == [
        {"with": "ann", "side": "front"}
    ]


def test_people_wait_before_closed_doors_and_hold_them_open() -> None:
    flat = world("{name: ann, path: [[2, 0], [4.7, 0]]}")
    assert flat.move_door("gate", False) is None
    flat.run(5.0)
    assert 3.44 < flat.people["ann"].x < 3.47
    assert flat.people["ann"].waits_for == "gate"
    assert flat.move_door("gate", True) is None
    flat.run(0.5)
    assert flat.move_door("gate", False) == "ann is in the way"
    flat.run(2.0)
    assert place(flat) == (4.7, 0.0)


def test_lasers_see_people_as_circles() -> None:
    flat = world("{name: ann, path: [[2, 0]]}")
    assert flat.scan("a")[180] == pytest.approx(1.75)
    flat.remove_person("ann")
    assert flat.scan("a")[180] == pytest.approx(5.0)


def test_people_can_be_added_and_removed_at_run_time() -> None:
    flat = World.load("empty")
    assert flat.people == {}
    flat.run(1.0)
    flat.add_person(PersonDescription("bob", ((1.0, 1.0), (1.0, 2.0)), color="#c0392b"))
    flat.run(0.5)
    flat.remove_person("bob")
    assert flat.people == {}
    comes, walks, goes = told(flat)
    assert (comes.time, comes.kind, comes.data["path"]) == (1.0, "person_comes", [[1.0, 1.0], [1.0, 2.0]])
    assert (walks.kind, goes.kind, goes.data) == (
        "person_walks",
        "person_goes",
        {"person": "bob", "x": 1.0, "y": pytest.approx(1.5)},
    )


def test_a_person_cannot_be_added_twice_or_onto_a_robot() -> None:
    flat = world()
    with pytest.raises(UsageError, match="duplicate name of a person: 'ann'"):
        flat.add_person(PersonDescription("ann", ((1.0, 1.0),)))
    with pytest.raises(UsageError, match="the name 'a' belongs to a robot"):
        flat.add_person(PersonDescription("a", ((1.0, 1.0),)))
    with pytest.raises(UsageError, match="no room for 'bob': a is in the way"):
        flat.add_person(PersonDescription("bob", ((0.3, 0.0),)))
    with pytest.raises(UsageError, match="unknown person 'bob'; people: ann"):
        flat.remove_person("bob")


def test_equal_runs_are_equal() -> None:
    def digest() -> str:
        flat = world("{name: ann, path: [[-2, 0.1], [2, 0.3], [0, -1]], loop: true, speed: 0.9}")
        for _ in range(40):
            flat.command("a", 0.2, 0.5)
            flat.run(0.25)
        return flat.ground_truth.digest()

    assert digest() == digest()


@pytest.mark.parametrize(
    ("ann", "message"),
    [
        ("{name: ann}", "lacks the key 'path'"),
        ("{name: ann, path: []}", "'path' has no points"),
        ("{name: ann, path: [[1, 1], [1, 1]]}", "'path' has the point [1, 1] twice in a row"),
        ("{name: ann, path: [[1, 1]], speed: 0}", "'speed' is 0, but must lie between 0.01 and 5"),
        ("{name: ann, path: [[1, 1]], careles: true}", "did you mean `careless`?"),
        ("{name: ann, path: [[1, 1]], color: sky}", "'sky' is not a colour"),
        ("{name: a, path: [[1, 1]]}", "duplicate name 'a'"),
        ("{name: ann, path: [[0.3, 0]]}", "'ann' starts at the place of the robot 'a'"),
        ("{name: ann, path: [[1, 1], [1, 9]]}", "the path of 'ann' from [1, 1] to [1, 9] leaves the world"),
        ("{name: ann, path: [[1, 1], [4.8, 1]]}", "passes a wall at less than the radius of 0.25 m"),
    ],
)
def test_mistakes_in_people_are_reported(ann: str, message: str) -> None:
    with pytest.raises(WorldError) as caught:
        read_world(WORLD.replace(ANN, ann))
    assert message in str(caught.value)


def test_a_path_through_a_thin_wall_is_found() -> None:
    text = "walls: [{segment: [[0, -1], [0, 1]]}]\nrobots: [{pose: {x: 2}}]\n"
    text += "people: [{name: ann, path: [[-1, 0], [1, 0]]}]"
    with pytest.raises(WorldError, match="passes a wall"):
        read_world(text)


def test_a_path_through_a_closed_door_is_valid() -> None:
    read_world(
        WORLD.replace("open: true", "open: false").replace(ANN, "{name: ann, path: [[3, 0], [4.7, 0]]}")
    )
