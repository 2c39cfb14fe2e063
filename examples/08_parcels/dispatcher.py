"""The dispatcher: an agent in Python that finds the shortest route to deliver all parcels."""

import heapq
from collections.abc import Iterator
from itertools import count
from math import dist
from typing import NamedTuple

from jacaros import Atom, PythonAgent, Structure

PLACES = {"hallway": (0, 0), "living_room": (2, 0), "kitchen": (2, 2), "bathroom": (0, 2)}
"""Where the robot stops in each room, in metres."""


class Situation(NamedTuple):
    """The robot's room, the waiting parcels (from, to), and the destinations of the parcels aboard."""

    room: str
    waiting: frozenset[tuple[str, str]]
    aboard: frozenset[str]

    def at(self, room: str) -> "Situation":
        """Return the situation after a visit to a room, where the robot unloads and loads all it can."""
        loaded = {goal for start, goal in self.waiting if start == room}
        left = frozenset(parcel for parcel in self.waiting if parcel[0] != room)
        return Situation(room, left, (self.aboard | loaded) - {room})

    @property
    def over(self) -> bool:
        """Whether all parcels have been delivered."""
        return not self.waiting and not self.aboard

    def wanted(self) -> Iterator[str]:
        """Yield the rooms in which the robot can load or unload."""
        yield from {start for start, _ in self.waiting} | self.aboard


def shortest_way(beginning: Situation) -> tuple[float, tuple[str, ...]]:
    """Return the length (m) and the rooms of the shortest route that delivers everything (uniform-cost search)."""
    ties = count()
    open_ways: list[tuple[float, int, Situation, tuple[str, ...]]] = [(0.0, next(ties), beginning, ())]
    closed: set[Situation] = set()
    while open_ways:
        metres, _, situation, way = heapq.heappop(open_ways)
        if situation.over:
            return metres, way
        if situation in closed:
            continue
        closed.add(situation)
        for room in sorted(situation.wanted()):
            far = metres + dist(PLACES[situation.room], PLACES[room])
            heapq.heappush(open_ways, (far, next(ties), situation.at(room), (*way, room)))
    raise AssertionError("a route always exists")


class Dispatcher(PythonAgent):
    """An agent that sends the robot to one room at a time, and replans after each: there may be new parcels."""

    async def run(self) -> None:
        while True:
            await self.until(lambda: self.has_property("parcel") or self.has_property("aboard"))
            metres, way = shortest_way(await self.situation())
            self.print(f"{metres:.1f} m: ", ", ".join(way))
            self.send("robot", "achieve", Structure("visit", (Atom(way[0]),)))
            await self.receive()  # the robot reports its visit

    async def situation(self) -> Situation:
        """Return the current situation: the robot knows its room, and the post knows the parcels."""
        at = await self.ask("robot", "at(Room)")
        waiting = frozenset((each.values[1], each.values[2]) for each in self.properties("parcel"))
        aboard = frozenset(each.values[1] for each in self.properties("aboard"))
        return Situation(at.arguments[0], waiting, aboard)
