"""``ArtCleaning``: the household of the thesis, with the tasks of each room."""

from typing import ClassVar

from jacaros.artifacts.env.artifact import Out, operation
from jacaros.artifacts.env.values import Structure
from jacaros.artifacts.kit.connection import MATCH_OPTIONS
from jacaros.artifacts.kit.ros_artifact import RosArtifact
from jacaros.ros.node import Publisher

ROOMS = ("hallway", "living Room", "kitchen", "bathroom")
"""The rooms by number, in the thesis's words: programs compare and print them."""

CARPET, FLOOR, TUB = "Carpet", "Floor", "Tub"
"""Objects to clean. The thesis writes "Flor", a typing error; as programs only print the word, it is corrected
here."""

BETWEEN_TASKS = 1.0
"""Seconds between two tasks in one room, as in the thesis."""

CLEANING = 2.5
"""Seconds that cleaning a room takes, as in the thesis."""

KINDS = ("vacuum", "mop", "scrub")
"""The kinds of tasks."""

Task = tuple[str, str]
"""Kind of a task, and its object."""

TASKS: tuple[tuple[Task, ...], ...] = (
    (),
    (("vacuum", CARPET),),
    (("mop", FLOOR),),
    (("scrub", TUB), ("mop", FLOOR)),
)
"""The tasks of the rooms, by number."""


def more_rooms(value: object) -> tuple[tuple[str, tuple[Task, ...]], ...]:
    """Read a list such as ``[room("study", [vacuum("Carpet")])]``: names of rooms with their tasks."""
    try:
        return tuple(_room(each) for each in value)  # type: ignore[attr-defined]  # TypeError if it is not a list
    except TypeError:
        raise ValueError("""a list such as [room("study", [vacuum("Carpet")])]""") from None


def _room(value: object) -> tuple[str, tuple[Task, ...]]:
    match value:
        case Structure("room", (str(name), list(tasks))):
            return str(name), tuple(_task(each) for each in tasks)
    raise ValueError(f"""rooms such as room("study", [vacuum("Carpet")]), found {value}""")


def _task(value: object) -> Task:
    match value:
        case Structure(kind, (str(thing),)) if kind in KINDS:
            return kind, str(thing)
    raise ValueError(f"""tasks such as vacuum("Carpet"), of the kinds {", ".join(KINDS)}, found {value}""")


class ArtCleaning(RosArtifact):
    """Shows the tasks of a room and the next room.

    Every task is also published as text, such as ``vacuum carpet living_room``, on ``/cleaning/task`` if the system
    has ROS: the embedded world logs it with the robot's true position, and a robot with a tool named after the first
    word starts it. An empty text on ``/cleaning/tool`` stops the tool at the end and when a pause begins; its name
    starts it again when the pause ends.

    Options:
        more_rooms(R): rooms in addition to the thesis's four, with their tasks, such as ``[room("study",
            [vacuum("Carpet")])]``; their numbers are 4, 5, and so on.
        match_timeout(S): how long the first task waits for a subscriber of ``/cleaning/task`` (3 s).
        unmatched(W): effect of a missing subscriber: ``warn`` (default; the task is published anyway) or ``fail``,
            with ``unmatched(Topic)``.

    Properties:
        atRoom(N): number of the room, 0 (hallway) to 3 (bathroom) or that of the last of `more_rooms`.
        vacuum(Object, Room), mop(Object, Room), scrub(Object, Room): the newest task of a kind; texts, empty before
            the first.
    """

    known_options: ClassVar = {"more_rooms": more_rooms, **MATCH_OPTIONS}
    _tasks: Publisher | None = None
    _tools: Publisher | None = None

    def open(self) -> None:
        """Define the properties; the robot begins in the hallway."""
        more = self.options.get("more_rooms", ())
        assert isinstance(more, tuple)
        self._rooms = (*ROOMS, *(name for name, _ in more))
        self._tasks_of = (*TASKS, *(tasks for _, tasks in more))
        self.define_property("atRoom", 0)
        for task in KINDS:
            self.define_property(task, "", "")
        if self.resources.get("ros") is not None:
            self._tasks = self.publisher("cleaning/task", "std_msgs/msg/String")
            self._tools = self.publisher("cleaning/tool", "std_msgs/msg/String")

    @operation(name="whereAmI")
    def where_am_i(self) -> None:
        """Show ``atRoom`` again, even if it has not changed."""
        self.update_property("atRoom", self.value("atRoom"))

    @operation(name="whereAmI")
    def give_where_i_am(self, room: Out, name: Out) -> None:
        """Give number and name of the room to the caller."""
        room.set(self.value("atRoom"))
        name.set(self._rooms[self.value("atRoom")])

    @operation(name="updateWhereAmI")
    def update_where_am_i(self) -> None:
        """Move on to the next room; after the last comes the first."""
        self.update_property("atRoom", (self.value("atRoom") + 1) % len(self._rooms))

    @operation(pausable=True)
    async def clean(self, room: int) -> None:
        """Show the tasks of *room* in turn, and take the time that they need.

        The work pauses while the intention is suspended: a robot that has left to recharge mops no floor. Fails with
        ``unknown_room(N)``.
        """
        if not 0 <= room < len(self._rooms):
            self.fail(f"unknown room {room}: expected 0 to {len(self._rooms) - 1}", "unknown_room", room)
        if self._tasks is not None and self._tasks_of[room]:
            await self.matched(self._tasks)
        tool = ""
        self.current.on_pause(lambda: self._use(""))
        self.current.on_resume(lambda: self._use(tool))
        try:
            for number, (task, thing) in enumerate(self._tasks_of[room]):
                if number:
                    await self._work(BETWEEN_TASKS)
                tool = task
                self.update_property(task, thing, self._rooms[room])
                self._publish(f"{task} {thing} {self._rooms[room].replace(' ', '_')}".lower())
            await self._work(CLEANING)
        finally:
            self._use("")

    async def _work(self, seconds: float) -> None:
        """Wait for some seconds, not counting pauses."""
        while seconds > 0.0:
            await self.sleep(seconds)
            over = self.clock.elapsed
            paused = await self.pause_point()
            # The time that was paused during the sleep is added.
            seconds = round(paused - (self.clock.elapsed - over), 6)

    def _publish(self, task: str) -> None:
        if self._tasks is not None:
            self._tasks.publish(self._tasks.message(data=task))

    def _use(self, tool: str) -> None:
        if self._tools is not None:
            self._tools.publish(self._tools.message(data=tool))
