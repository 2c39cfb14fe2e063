"""The disturbances of the experiment: fault files made from a seed, the same for every side."""

import random
from collections.abc import Callable, Mapping
from typing import NamedTuple

Draw = random.Random

FURTHER = 1000
"""Seeds above this have one of the further kinds of disturbances."""

SEEN = 200
"""Seeds above this, in either series, are kept out of what the programs are tuned with."""

DOCK = (1.0, 1.0)
"""Where the dock is in the worlds in which robots recharge, in metres."""

COMMANDS = ("/cmd_vel", "/cmd_vel_mux/input/navi")
SENSORS = ("/odom", "/tf", "/battery_state")


class Surroundings(NamedTuple):
    """Where and when a scenario can be disturbed.

    Attributes:
        seconds: how long a run without disturbances takes, about.
        area: least x, least y, greatest x, greatest y of where a robot can be put, in metres.
        doors: names of the doors that can close.
        recharges: whether the robot goes to its dock when the battery is low.
        navigates: whether some side sends goals to Nav2.
        drives: whether the robot drives.
        grips: whether the robot has a gripper.
    """

    seconds: float
    area: tuple[float, float, float, float]
    doors: tuple[str, ...] = ()
    recharges: bool = False
    navigates: bool = False
    drives: bool = True
    grips: bool = False


SURROUNDINGS: Mapping[str, Surroundings] = {
    "out_and_back": Surroundings(20.0, (-1.0, -1.0, 1.0, 1.0)),
    "square": Surroundings(35.0, (-0.5, -0.5, 1.5, 1.5)),
    "fake_battery": Surroundings(200.0, (-1.0, -1.0, 1.0, 1.0), drives=False),
    "patrol": Surroundings(140.0, (0.0, 0.0, 2.0, 2.0), recharges=True, navigates=True),
    "house_cleaning": Surroundings(
        190.0, (0.0, 0.0, 2.0, 2.0), ("living_room", "bathroom"), recharges=True, navigates=True
    ),
    "fetch": Surroundings(40.0, (-2.0, -1.0, 2.0, 1.0), grips=True),
}


def kinds_for(scenario: str, seed: int = 0) -> list[str]:
    """The kinds of disturbances that can happen in a scenario, in the series of a seed."""
    where = SURROUNDINGS[scenario]
    if is_further(seed):
        docks, drives = (
            dict.fromkeys(("dead_dock", "wrong_dock", "dirty_contact"), where.recharges),
            where.drives,
        )
        needs = {**docks, "missed_grasp": where.grips}
        return [kind for kind in FURTHER_KINDS if needs.get(kind, drives)]
    possible = {"door": bool(where.doors), "battery": where.recharges, "aborted": where.navigates}
    return [kind for kind in KINDS if possible.get(kind, True)]


def kind_of(scenario: str, seed: int) -> str:
    """The kind of disturbance that a run with a seed has: all kinds take turns."""
    kinds = kinds_for(scenario, seed)
    return kinds[seed % FURTHER % len(kinds)]


def held_out(seed: int) -> bool:
    """Whether a seed is kept out of what the programs were tuned with."""
    return seed % FURTHER > SEEN


def is_further(seed: int) -> bool:
    """Whether a run with a seed has one of the further kinds of disturbances."""
    return seed > FURTHER


def faults_for(scenario: str, seed: int) -> str:
    """The text of the fault file for one run."""
    kind = kind_of(scenario, seed)
    draw = Draw(f"{scenario}/{kind}/{seed}")
    faults = {**KINDS, **FURTHER_KINDS}[kind](draw, SURROUNDINGS[scenario])
    return "\n".join(["faults:", *(f"  f{number}: {{{fault}}}" for number, fault in enumerate(faults)), ""])


def _slip(draw: Draw, where: Surroundings) -> list[str]:
    """A wet floor for a tenth to a half of the run."""
    lasts = draw.uniform(0.1, 0.5) * where.seconds
    return [f"kind: wheel_slip, share: {draw.uniform(0.1, 0.4):.2f}, {_at(draw, where)}, for: {lasts:.1f}"]


def _lost(draw: Draw, where: Surroundings) -> list[str]:
    """Every third to tenth message of sensors and commands is lost, all the time."""
    share = draw.uniform(0.1, 0.3)
    return [f"kind: lost, topic: {topic}, share: {share:.2f}, at: 0" for topic in (*SENSORS, *COMMANDS)]


def _late(draw: Draw, where: Surroundings) -> list[str]:
    """Messages of sensors and commands come late, all the time."""
    seconds = draw.uniform(0.05, 0.25)
    return [
        f"kind: delayed, topic: {topic}, seconds: {seconds:.2f}, jitter: 0.05, at: 0"
        for topic in (*SENSORS, *COMMANDS)
    ]


def _battery(draw: Draw, where: Surroundings) -> list[str]:
    """The battery loses much of its charge, twice."""
    return [f"kind: battery_drop, to: {draw.uniform(8, 40):.0f}, {_at(draw, where)}" for _ in range(2)]


def _door(draw: Draw, where: Surroundings) -> list[str]:
    """A door is closed for some time, twice."""
    return [
        f"kind: closed_door, door: {draw.choice(where.doors)}, {_at(draw, where)}, for: {draw.uniform(5, 40):.1f}"
        for _ in range(2)
    ]


def _aborted(draw: Draw, where: Surroundings) -> list[str]:
    """The navigation aborts its goals for some seconds, four times."""
    return [
        f"kind: aborted_action, action: /navigate_to_pose, {_at(draw, where)}, for: {draw.uniform(0.5, 5):.1f}"
        for _ in range(4)
    ]


def _carried(draw: Draw, where: Surroundings) -> list[str]:
    """Lift the robot and put it down elsewhere."""
    return [f"kind: kidnapped_robot, to: {_pose(draw, where)}, {_at(draw, where)}"]


def _pose(draw: Draw, where: Surroundings) -> str:
    x0, y0, x1, y1 = where.area
    x, y, yaw = draw.uniform(x0, x1), draw.uniform(y0, y1), draw.uniform(-180, 180)
    return f"{{x: {x:.2f}, y: {y:.2f}, yaw_degrees: {yaw:.0f}}}"


def _dead_dock(draw: Draw, where: Surroundings) -> list[str]:
    """The dock has no current for some time, twice."""
    return [
        f"kind: dead_dock, dock: dock, {_soon(draw, where)}, for: {draw.uniform(30, 90):.1f}"
        for _ in range(2)
    ]


def _wrong_dock(draw: Draw, where: Surroundings) -> list[str]:
    """Another robot's dock, without current for this one, is in the place of the dock for some time, twice."""
    to = f"to: {{x: {DOCK[0]:g}, y: {DOCK[1]:g}}}"
    return [
        f"kind: wrong_dock, {to}, {_soon(draw, where)}, for: {draw.uniform(30, 90):.1f}" for _ in range(2)
    ]


def _dirty_contact(draw: Draw, where: Surroundings) -> list[str]:
    """The current of the dock comes and goes, all the time."""
    share, period = draw.uniform(0.2, 0.6), draw.uniform(0.5, 3.0)
    return [f"kind: dirty_contact, dock: dock, share: {share:.2f}, period: {period:.1f}, at: 0"]


def _lost_localisation(draw: Draw, where: Surroundings) -> list[str]:
    """The robot believes to be elsewhere."""
    return [f"kind: lost_localisation, to: {_pose(draw, where)}, {_soon(draw, where)}"]


def _person_in_the_way(draw: Draw, where: Surroundings) -> list[str]:
    """A person stands in front of the robot for a minute, twice."""
    return [
        f"kind: person_in_the_way, gap: {draw.uniform(0.4, 0.8):.2f}, {_soon(draw, where)}, for: 60"
        for _ in range(2)
    ]


def _missed_grasp(draw: Draw, where: Surroundings) -> list[str]:
    """The gripper closes on nothing, now and then."""
    return [f"kind: missed_grasp, share: {draw.uniform(0.3, 1):.2f}, at: 0"]


def _soon(draw: Draw, where: Surroundings) -> str:
    """Within half of the run, so that quick programs are disturbed, too."""
    return f"at: {draw.uniform(0.05, 0.5) * where.seconds:.1f}"


def _at(draw: Draw, where: Surroundings) -> str:
    return f"at: {draw.uniform(0.05, 0.8) * where.seconds:.1f}"


KINDS: Mapping[str, Callable[[Draw, Surroundings], list[str]]] = {
    "slip": _slip,
    "lost": _lost,
    "late": _late,
    "battery": _battery,
    "door": _door,
    "aborted": _aborted,
    "carried": _carried,
}

FURTHER_KINDS: Mapping[str, Callable[[Draw, Surroundings], list[str]]] = {
    "dead_dock": _dead_dock,
    "wrong_dock": _wrong_dock,
    "dirty_contact": _dirty_contact,
    "lost_localisation": _lost_localisation,
    "person_in_the_way": _person_in_the_way,
    "missed_grasp": _missed_grasp,
}
"""The kinds of the further runs, by the names of their faults."""
