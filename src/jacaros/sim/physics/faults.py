"""The faults of a running world: their schedule, and their effects on the world and on its messages."""

import copy
import math
import random
from collections.abc import Callable, Iterable, Sequence
from dataclasses import fields, is_dataclass
from functools import partial
from typing import Any, Protocol

from jacaros.errors import UsageError
from jacaros.sim.data.faults import ACTIONS, MESSAGES, Fault
from jacaros.sim.data.world import PersonDescription, WorldDescription
from jacaros.sim.physics.robot import Robot

Effect = Callable[[Any], Sequence[tuple[float, Any]]]
"""Takes a message and returns the messages delivered instead, each with its delay in seconds; empty if it is lost."""

_KEPT = frozenset(
    {"header", "angle_min", "angle_max", "angle_increment", "range_min", "range_max", "scan_time"}
)
"""Fields that describe a sensor and are not measurements."""


def effect_of(fault: Fault, seed: int) -> Effect:
    """Return the effect of a fault on the messages of its topic."""
    chance = random.Random(f"{seed}/{fault.name}/messages")
    if fault.kind == "dead":
        return lambda message: ()
    if fault.kind == "frozen":
        return _Frozen().replace
    if fault.kind == "nan":
        return lambda message: ((0.0, _without_numbers(copy.deepcopy(message))),)
    if fault.kind == "lost":
        return lambda message: () if chance.random() < fault.share else ((0.0, message),)
    if fault.kind == "delayed":
        return lambda message: ((fault.seconds + fault.jitter * chance.random(), message),)
    return lambda message: [(0.0, message)] * fault.copies


class _Frozen:
    """Repeats the first message, with the stamps of the replaced messages."""

    def __init__(self) -> None:
        self._first: Any = None

    def replace(self, message: Any) -> Sequence[tuple[float, Any]]:
        if self._first is None:
            self._first = copy.deepcopy(message)
        repeated = copy.deepcopy(self._first)
        if hasattr(message, "header"):
            repeated.header.stamp = message.header.stamp
        return ((0.0, repeated),)


def _without_numbers(message: Any) -> Any:
    """Set all floating-point measurements to NaN."""
    for name in _fields(message):
        value = getattr(message, name)
        if name in _KEPT or "covariance" in name:
            continue
        if isinstance(value, float):
            setattr(message, name, math.nan)
        elif _fields(value):
            _without_numbers(value)
        elif not isinstance(value, str | bytes) and isinstance(value, Iterable):
            # For arrays, the items as Python values.
            items = list(getattr(value, "tolist", value.__iter__)())
            if items and all(isinstance(item, float) for item in items):
                setattr(message, name, [math.nan] * len(items))
    return message


def _fields(value: Any) -> list[str]:
    """Return the field names of a message of any middleware; an empty list for other values."""
    if is_dataclass(value):
        return [field.name for field in fields(value)]
    return [
        slot.removeprefix("_") for slot in getattr(type(value), "__slots__", ()) if slot != "_check_fields"
    ]


Undo = Callable[[], object]
Abort = Callable[[str], object]
"""Aborts a goal because of a fault."""


class FaultyWorld(Protocol):
    """The part of `jacaros.sim.physics.world.World` that faults use."""

    description: WorldDescription
    time: float
    doors: dict[str, bool]
    dead_docks: set[str]
    stuck_doors: dict[str, Callable[[], bool]]

    def robot(self, name: str) -> Robot: ...
    def move_door(self, name: str, opened: bool) -> str | None: ...
    def add_person(self, description: PersonDescription) -> object: ...
    def remove_person(self, name: str) -> None: ...
    def note_fault(self, name: str, data: dict[str, Any]) -> None: ...


class Refused(Exception):
    """Raised when a fault cannot happen now."""


class Faults:
    """The faults of a world, by name.

    Each start and end is an event ``fault`` of the ground truth, with ``fault`` (its name), ``kind`` and ``state``:
    ``begins``, ``ends``, or ``refused`` with ``why``.

    Args:
        world: affected world.
        faults: its faults.

    Attributes:
        by_name: faults by name.
        next: time of the next start or end, in seconds of the world; infinite without one.
        topics, actions: all topics and actions with faults, active or not.
    """

    def __init__(self, world: FaultyWorld, faults: Iterable[Fault] = ()) -> None:
        self._world = world
        self.by_name = {fault.name: fault for fault in faults}
        self.topics = frozenset(fault.topic for fault in self.by_name.values() if fault.topic)
        self.actions = frozenset(fault.action for fault in self.by_name.values() if fault.action)
        self._begins = {fault.name: fault.at for fault in self.by_name.values() if fault.at is not None}
        self._ends: dict[str, float] = {}
        self._undo: dict[str, Undo] = {}
        self._effects: dict[str, dict[str, Effect]] = {}
        self._aborting: dict[str, tuple[str, Callable[[], bool]]] = {}
        """Active faults that abort goals: their actions, and a function that decides about the next goal."""
        self._goals: dict[Abort, str] = {}
        self._look_ahead()

    @property
    def at_work(self) -> list[str]:
        """Names of the active faults, oldest first."""
        return list(self._undo)

    def effects(self, topic: str) -> Iterable[Effect]:
        """Return the effects of active faults on the messages of a topic, oldest first."""
        return self._effects.get(topic, {}).values()

    def watch_goal(self, action: str, abort: Abort) -> Undo:
        """Call *abort* with the name of each fault that aborts goals of *action*; immediately if one is active.

        Returns:
            A function that stops this.
        """
        for name, (meant, happens) in self._aborting.items():
            if meant == action and happens():
                abort(name)
                break
        self._goals[abort] = action
        return partial(self._goals.pop, abort, None)

    def step(self, time: float) -> None:
        """End and start the faults that are due at *time* (seconds of the world), ends first."""
        for name in [name for name, end in self._ends.items() if end <= time]:
            self.end(name)
        for name in [name for name, begin in self._begins.items() if begin <= time]:
            del self._begins[name]
            self.begin(name)
        self._look_ahead()

    def _look_ahead(self) -> None:
        self.next = min((*self._begins.values(), *self._ends.values()), default=math.inf)

    def begin(self, name: str) -> str | None:
        """Start a fault; an active fault continues.

        Returns:
            Why it cannot start, or None.

        Raises:
            UsageError: the fault is unknown.
        """
        fault = self._named(name)
        if name in self._undo:
            return None
        try:
            undo = self._effect(fault)
        except (Refused, UsageError) as refused:
            self._tell(fault, "refused", why=str(refused))
            return str(refused)
        if undo is not None:
            self._undo[name] = undo
            if fault.lasts is not None:
                self._ends[name] = self._world.time + fault.lasts
                self._look_ahead()
        self._tell(fault, "begins")
        return None

    def end(self, name: str) -> None:
        """End a fault, if it is active.

        Raises:
            UsageError: the fault is unknown.
        """
        fault = self._named(name)
        self._ends.pop(name, None)
        self._look_ahead()
        undo = self._undo.pop(name, None)
        if undo is not None:
            undo()
            self._tell(fault, "ends")

    def switch(self, name: str, on: bool) -> str | None:
        """Start or end a fault; return why it cannot start, or None.

        Raises:
            UsageError: the fault is unknown.
        """
        if on:
            return self.begin(name)
        self.end(name)
        return None

    def _named(self, name: str) -> Fault:
        if name not in self.by_name:
            raise UsageError(f"unknown fault '{name}'; faults: {', '.join(self.by_name) or 'none'}")
        return self.by_name[name]

    def _tell(self, fault: Fault, state: str, **more: str) -> None:
        self._world.note_fault(fault.robot, {"fault": fault.name, "kind": fault.kind, "state": state, **more})

    def _effect(self, fault: Fault) -> Undo | None:
        """Apply a fault, and return the function that ends it; None for faults without duration.

        Raises:
            Refused, UsageError: the fault cannot happen now.
        """
        if fault.kind in MESSAGES:
            active = self._effects.setdefault(fault.topic, {})
            active[fault.name] = effect_of(fault, self._world.description.seed)
            return partial(active.pop, fault.name)
        if fault.kind in ACTIONS:
            happens = _chance(self._world, fault)
            self._aborting[fault.name] = fault.action, happens
            for abort in [abort for abort, action in self._goals.items() if action == fault.action]:
                if happens():
                    abort(fault.name)
            return partial(self._aborting.pop, fault.name)
        return _EFFECTS[fault.kind](self._world, fault)


def _chance(world: FaultyWorld, fault: Fault) -> Callable[[], bool]:
    """Return a function that decides each time whether a fault happens, with the probability ``share``."""
    draw = random.Random(f"{world.description.seed}/{fault.name}/{fault.kind}").random
    return lambda: draw() < fault.share


def _slip(world: FaultyWorld, fault: Fault) -> Undo:
    robot = world.robot(fault.robot)
    draw = random.Random(f"{world.description.seed}/{fault.name}/slip").random
    robot.grip = lambda: max(0.0, 1.0 - 2.0 * fault.share * draw())
    return partial(setattr, robot, "grip", None)


def _block(world: FaultyWorld, fault: Fault) -> Undo:
    robot = world.robot(fault.robot)
    robot.blocked_wheel = fault.wheel
    return partial(setattr, robot, "blocked_wheel", "")


def _kidnap(world: FaultyWorld, fault: Fault) -> None:
    world.robot(fault.robot).put_down(fault.pose)


def _drop(world: FaultyWorld, fault: Fault) -> None:
    battery = world.robot(fault.robot).battery
    battery.level = min(battery.level, fault.level)


def _cut_current(world: FaultyWorld, fault: Fault) -> Undo:
    world.dead_docks.add(fault.place)
    return partial(world.dead_docks.discard, fault.place)


def _close_door(world: FaultyWorld, fault: Fault) -> Undo:
    if not world.doors[fault.place]:
        return lambda: None
    why = world.move_door(fault.place, opened=False)
    if why is not None:
        raise Refused(why)
    return partial(world.move_door, fault.place, opened=True)


def _jam_door(world: FaultyWorld, fault: Fault) -> Undo:
    world.stuck_doors[fault.place] = _chance(world, fault)
    return partial(world.stuck_doors.pop, fault.place, None)


def _let_come(world: FaultyWorld, fault: Fault) -> Undo:
    assert fault.person is not None
    world.add_person(fault.person)
    return partial(world.remove_person, fault.name)


_EFFECTS: dict[str, Callable[[FaultyWorld, Fault], Undo | None]] = {
    "wheel_slip": _slip,
    "blocked_wheel": _block,
    "kidnapped_robot": _kidnap,
    "battery_drop": _drop,
    "dead_dock": _cut_current,
    "closed_door": _close_door,
    "stuck_door": _jam_door,
    "person": _let_come,
}
