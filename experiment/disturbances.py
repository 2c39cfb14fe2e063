"""Draw the disturbances of the experiment: fault files made from a seed, the same for every side."""

import random
from collections.abc import Callable, Mapping
from typing import NamedTuple

Draw = random.Random

SEEDS = range(2001, 2201)
"""Seeds of the comparison."""

QUARTER = range(2001, 2051)
"""Seeds of the sides that run a quarter of the comparison."""

FURTHER_SEEDS = range(3001, 3021)
"""Seeds of the further kinds of disturbances."""

DRAWS = 10
"""How often a seed is drawn before it is left out: a disturbance must have an effect on both sides of a pair."""

DOCK = (1.0, 1.0)
"""Where the dock is in the worlds in which robots recharge, in metres."""

COMMANDS = ("/cmd_vel", "/cmd_vel_mux/input/navi")
SENSORS = ("/odom", "/tf", "/battery_state")


class Surroundings(NamedTuple):
    """Where and when a scenario can be disturbed.

    Attributes:
        seconds: how long a run without disturbances takes, about.
        way: metres that a run without disturbances drives; 0 if the robot stands.
        area: least x, least y, greatest x, greatest y of where a robot can believe to be, in metres.
        doors: names of the doors that can close.
        recharges: whether the robot goes to its dock when the battery is low.
        navigates: whether some side sends goals to Nav2.
        grips: whether the robot has a gripper.
    """

    seconds: float
    way: float
    area: tuple[float, float, float, float]
    doors: tuple[str, ...] = ()
    recharges: bool = False
    navigates: bool = False
    grips: bool = False

    @property
    def topics(self) -> tuple[str, ...]:
        """The topics of the sensors and commands that matter in the scenario."""
        return (*SENSORS, *COMMANDS) if self.way else ("/battery_state",)


SURROUNDINGS: Mapping[str, Surroundings] = {
    "out_and_back": Surroundings(20.0, 2.6, (-1.0, -1.0, 1.0, 1.0)),
    "square": Surroundings(35.0, 4.0, (-0.5, -0.5, 1.5, 1.5)),
    "fake_battery": Surroundings(200.0, 0.0, (-1.0, -1.0, 1.0, 1.0)),
    "patrol": Surroundings(140.0, 31.0, (0.0, 0.0, 2.0, 2.0), recharges=True, navigates=True),
    "house_cleaning": Surroundings(
        190.0, 32.0, (0.0, 0.0, 2.0, 2.0), ("living_room", "bathroom"), recharges=True, navigates=True
    ),
    "fetch": Surroundings(40.0, 7.5, (-2.0, -1.0, 2.0, 1.0), grips=True),
}


class Disturbance(NamedTuple):
    """What happens to one run.

    Attributes:
        kind: of the disturbance.
        dose: how strong it is, in the unit of its kind.
        share: of the way at which it strikes; 0 from the beginning.
        faults: text of the fault file.
    """

    kind: str
    dose: float
    share: float
    faults: str


def disturbance(scenario: str, seed: int, draw: int = 0) -> Disturbance:
    """Return the disturbance of a seed at its *draw*-th draw, counted from 0."""
    kind = kind_of(scenario, seed)
    where, source = SURROUNDINGS[scenario], Draw(f"{scenario}/{kind}/{seed}/{draw}")
    effect = {**KINDS, **FURTHER_KINDS}[kind]
    dose = round(source.uniform(effect.least, effect.most), 3)
    share = round(source.uniform(0.05, effect.latest), 3) if effect.latest else 0.0
    begins = f"after: {{metres: {share * where.way:.2f}}}" if share else effect.begins
    faults = [
        f"  f{number}: {{{each}, {begins}}}" for number, each in enumerate(effect.faults(dose, source, where))
    ]
    return Disturbance(kind, dose, share, "\n".join(["faults:", *faults, ""]))


def kinds_for(scenario: str, seed: int = SEEDS[0]) -> list[str]:
    """Return the kinds of disturbances that can happen in a scenario, in the series of a seed."""
    kinds = FURTHER_KINDS if is_further(seed) else KINDS
    return [name for name, kind in kinds.items() if kind.possible(SURROUNDINGS[scenario])]


def kind_of(scenario: str, seed: int) -> str:
    """Return the kind of disturbance that a run with a seed has: all kinds take turns."""
    kinds = kinds_for(scenario, seed)
    return kinds[seed % len(kinds)]


def is_further(seed: int) -> bool:
    """Return whether a run with a seed has one of the further kinds of disturbances."""
    return seed >= FURTHER_SEEDS[0]


# ---- faults, without the moment at which they begin


def _slip(dose: float, draw: Draw, where: Surroundings) -> list[str]:
    lasts = draw.uniform(0.1, 0.5) * where.seconds
    return [f"kind: wheel_slip, share: {dose:g}, for: {lasts:.1f}"]


def _late(dose: float, draw: Draw, where: Surroundings) -> list[str]:
    return [
        f"kind: delayed, topic: {topic}, seconds: {dose:g}, jitter: {dose / 5:.4f}" for topic in where.topics
    ]


def _lost(dose: float, draw: Draw, where: Surroundings) -> list[str]:
    return [f"kind: lost, topic: {topic}, share: {dose:g}" for topic in where.topics]


def _carried(dose: float, draw: Draw, where: Surroundings) -> list[str]:
    return [f"kind: kidnapped_robot, by: {dose:g}"]


def _battery(dose: float, draw: Draw, where: Surroundings) -> list[str]:
    return [f"kind: battery_drop, to: {100 - dose:g}"]


def _aborted(dose: float, draw: Draw, where: Surroundings) -> list[str]:
    return [f"kind: aborted_action, action: /navigate_to_pose, for: {dose:g}"]


def _door(dose: float, draw: Draw, where: Surroundings) -> list[str]:
    return [f"kind: closed_door, door: {draw.choice(where.doors)}, for: {dose:g}"]


def _dead_dock(dose: float, draw: Draw, where: Surroundings) -> list[str]:
    return [f"kind: dead_dock, dock: dock, for: {dose:g}"]


def _wrong_dock(dose: float, draw: Draw, where: Surroundings) -> list[str]:
    """Another robot's dock, without current for this one, is in the place of the dock."""
    return [f"kind: wrong_dock, to: {{x: {DOCK[0]:g}, y: {DOCK[1]:g}}}, for: {dose:g}"]


def _dirty_contact(dose: float, draw: Draw, where: Surroundings) -> list[str]:
    """The current of the dock comes and goes."""
    return [f"kind: dirty_contact, dock: dock, share: {dose:g}, period: {draw.uniform(0.5, 3.0):.1f}"]


def _lost_localisation(dose: float, draw: Draw, where: Surroundings) -> list[str]:
    """The robot believes to be elsewhere."""
    x0, y0, x1, y1 = where.area
    place = f"x: {draw.uniform(x0, x1):.2f}, y: {draw.uniform(y0, y1):.2f}"
    return [f"kind: lost_localisation, to: {{{place}, yaw_degrees: {dose:.0f}}}"]


def _person_in_the_way(dose: float, draw: Draw, where: Surroundings) -> list[str]:
    """A person stands in front of the robot."""
    return [f"kind: person_in_the_way, gap: {draw.uniform(0.4, 0.8):.2f}, for: {dose:g}"]


def _missed_grasp(dose: float, draw: Draw, where: Surroundings) -> list[str]:
    """The gripper closes on nothing, now and then."""
    return [f"kind: missed_grasp, share: {dose:g}"]


# ---- kinds


def _drives(where: Surroundings) -> bool:
    return where.way > 0


def _recharges(where: Surroundings) -> bool:
    return where.recharges


def _navigates(where: Surroundings) -> bool:
    return where.navigates


def _has_doors(where: Surroundings) -> bool:
    return bool(where.doors)


def _grips(where: Surroundings) -> bool:
    return where.grips


def _everywhere(where: Surroundings) -> bool:
    return True


class Kind(NamedTuple):
    """A kind of disturbance.

    Attributes:
        faults: makes the entries of the fault file from the dose, without the moment at which they begin.
        possible: whether a scenario can have it.
        least, most: range of the dose.
        latest: greatest share of the way at which it strikes; 0 if it strikes at another moment.
        begins: that moment; by default the begin of the run.
    """

    faults: Callable[[float, Draw, Surroundings], list[str]]
    possible: Callable[[Surroundings], bool]
    least: float
    most: float
    latest: float = 0.8
    begins: str = "at: 0"


KINDS: Mapping[str, Kind] = {
    "slip": Kind(_slip, _drives, 0.0, 0.6),
    "late": Kind(_late, _everywhere, 0.0, 0.4, latest=0.0),
    "lost": Kind(_lost, _everywhere, 0.0, 0.6, latest=0.0),
    "carried": Kind(_carried, _drives, 0.0, 3.0),
    "battery": Kind(_battery, _recharges, 60.0, 95.0),
    "aborted": Kind(_aborted, _navigates, 0.0, 20.0),
    "door": Kind(_door, _has_doors, 0.0, 60.0),
}
"""The kinds of the protocol."""

SOON_LOW = "after: {battery: 25}"
"""A little before the robot drives to its dock, where it feels what is wrong with that."""

FURTHER_KINDS: Mapping[str, Kind] = {
    "dead_dock": Kind(_dead_dock, _recharges, 30.0, 90.0, latest=0.0, begins=SOON_LOW),
    "wrong_dock": Kind(_wrong_dock, _recharges, 30.0, 90.0, latest=0.0, begins=SOON_LOW),
    "dirty_contact": Kind(_dirty_contact, _recharges, 0.2, 0.6, latest=0.0),
    "lost_localisation": Kind(_lost_localisation, _drives, -180.0, 180.0, latest=0.5),
    "person_in_the_way": Kind(_person_in_the_way, _drives, 30.0, 90.0, latest=0.5),
    "missed_grasp": Kind(_missed_grasp, _grips, 0.3, 1.0, latest=0.0),
}
"""Further kinds, outside of the comparison, by the names of their faults."""
