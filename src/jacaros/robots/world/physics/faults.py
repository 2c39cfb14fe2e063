"""The faults of a running world: when they begin and end, and what they affect."""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

from jacaros.robots.world.data.faults import MESSAGES, Fault, Progress
from jacaros.runtime.errors import UsageError

Undo = Callable[[], object]
AbortGoal = Callable[[str], object]
"""Aborts a goal because of a fault."""
Felt = Callable[[], bool]
"""Returns whether a fault affects a robot now."""


class Effect(NamedTuple):
    """What a fault that starts does.

    Attributes:
        undo: ends it; None for faults without duration.
        felt: whether it affects a robot from the start, or a function that is called at each step until it does. After
            False, `Faults.acts` reports an effect.
        data: further data of the event.
    """

    undo: Undo | None = None
    felt: bool | Felt = False
    data: Mapping[str, Any] | None = None


@dataclass(slots=True)
class TopicFault:
    """An active fault of the messages of a topic.

    Attributes:
        fault: the fault.
        draw: returns a random number from 0 to 1.
        first: the first message since its start.
    """

    fault: Fault
    draw: Callable[[], float]
    first: Any = None


class Faults:
    """The faults of a world, by name.

    Each start and end is an event ``fault`` of the ground truth, with ``fault`` (its name), ``kind`` and ``state``:
    ``begins``, ``ends``, or ``refused`` with ``why``. Between them, once, ``acts``: the first effect on a robot.

    Args:
        faults: its faults.
        seed: seed of the world.
        now: returns the time of the world, in seconds.
        happen: lets a fault happen in the world. It raises `UsageError` if the fault cannot happen now.
        reached: returns whether a robot has made a progress.
        note: takes the events, with the affected robot ("" for none).

    Attributes:
        by_name: faults by name.
        next: time of the next start or end, in seconds of the world; infinite without one, and in the past while each
            step can bring a start or an effect.
        topics, actions: all topics and actions with faults, active or not.
    """

    def __init__(
        self,
        faults: Iterable[Fault],
        seed: int,
        now: Callable[[], float],
        happen: Callable[[Fault], Effect],
        reached: Callable[[Progress], bool],
        note: Callable[[str, dict[str, Any]], object],
    ) -> None:
        self._seed, self._now, self._happen, self._reached, self._note = seed, now, happen, reached, note
        self.by_name = {fault.name: fault for fault in faults}
        self.topics = frozenset(fault.topic for fault in self.by_name.values() if fault.topic)
        self.actions = frozenset(fault.action for fault in self.by_name.values() if fault.action)
        self._begins = {fault.name: fault.at for fault in self.by_name.values() if fault.at is not None}
        self._waiting = {fault.name: fault.after for fault in self.by_name.values() if fault.after}
        self._ends: dict[str, float] = {}
        self._unfelt: dict[str, Felt | None] = {}
        """Faults that have started and had no effect so far."""
        self._undo: dict[str, Undo] = {}
        self._disturbances: dict[str, dict[str, TopicFault]] = {}
        self._aborting: dict[str, tuple[str, Callable[[], bool]]] = {}
        """Active faults that abort goals: their actions, and a function that decides about the next goal."""
        self._goals: dict[AbortGoal, str] = {}
        self._look_ahead()

    @property
    def at_work(self) -> list[str]:
        """Names of the active faults, oldest first."""
        return list(self._undo)

    def disturbances(self, topic: str) -> Iterable[TopicFault]:
        """Return the active faults of the messages of a topic, oldest first."""
        return self._disturbances.get(topic, {}).values()

    def watch_goal(self, action: str, abort: AbortGoal) -> Undo:
        """Call *abort* with the name of each fault that aborts goals of *action*; immediately if one is active.

        Returns:
            A function that stops this.
        """
        for name, (meant, happens) in self._aborting.items():
            if meant == action and happens():
                abort(name)
                self.acts(name)
                break
        self._goals[abort] = action
        return partial(self._goals.pop, abort, None)

    def step(self, time: float) -> None:
        """End and start the faults that are due at *time* (seconds of the world), ends first."""
        if time >= self._due:
            for name in [name for name, end in self._ends.items() if end <= time]:
                self.end(name)
            for name in [name for name, begin in self._begins.items() if begin <= time]:
                del self._begins[name]
                self.begin(name)
            self._look_ahead()
        for name, progress in tuple(self._waiting.items()):
            if self._reached(progress):
                del self._waiting[name]
                self.begin(name)
                self._look_ahead()
        for name, felt in tuple(self._unfelt.items()):
            if felt is not None and felt():
                self.acts(name)

    def _look_ahead(self) -> None:
        self._due = min((*self._begins.values(), *self._ends.values()), default=math.inf)
        self.next = -math.inf if self._waiting or any(self._unfelt.values()) else self._due

    def acts(self, name: str) -> None:
        """Record that a fault has an effect, if it is the first one since its start."""
        if name in self._unfelt:
            del self._unfelt[name]
            self._tell(self.by_name[name], "acts")
            self._look_ahead()

    def chance(self, fault: Fault) -> Callable[[], bool]:
        """Return a function that decides each time whether a fault happens, and reports its effect."""
        happens = fault.chance(self._seed)

        def decide() -> bool:
            decided = happens()
            if decided:
                self.acts(fault.name)
            return decided

        return decide

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
            effect = self._effect(fault)
        except UsageError as refused:
            self._tell(fault, "refused", why=str(refused))
            return str(refused)
        if effect.undo is not None:
            self._undo[name] = effect.undo
            if fault.lasts is not None:
                self._ends[name] = self._now() + fault.lasts
        self._tell(fault, "begins", **(effect.data or {}))
        self._unfelt[name] = None if isinstance(effect.felt, bool) else effect.felt
        if effect.felt is True:
            self.acts(name)
        self._look_ahead()
        return None

    def end(self, name: str) -> None:
        """End a fault, if it is active.

        Raises:
            UsageError: the fault is unknown.
        """
        fault = self._named(name)
        self._ends.pop(name, None)
        undo = self._undo.pop(name, None)
        if undo is not None:
            undo()
            self._unfelt.pop(name, None)
            self._tell(fault, "ends")
        self._look_ahead()

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

    def _tell(self, fault: Fault, state: str, **more: Any) -> None:
        self._note(fault.robot, {"fault": fault.name, "kind": fault.kind, "state": state, **more})

    def _effect(self, fault: Fault) -> Effect:
        """Apply a fault.

        Raises:
            UsageError: the fault cannot happen now.
        """
        if fault.kind in MESSAGES:
            active = self._disturbances.setdefault(fault.topic, {})
            active[fault.name] = TopicFault(fault, fault.draw(self._seed, "messages"))
            return Effect(partial(active.pop, fault.name))
        if fault.kind == "aborted_action":
            happens = fault.chance(self._seed)
            self._aborting[fault.name] = fault.action, happens
            running = [abort for abort, action in self._goals.items() if action == fault.action]
            aborted = [abort for abort in running if happens()]
            for abort in aborted:
                abort(fault.name)
            return Effect(partial(self._aborting.pop, fault.name), bool(aborted))
        return self._happen(fault)
