"""``ArtCleaning``: the household of the thesis, which says what is to be done in which room."""

from typing import ClassVar

from jacaros.artifacts.kit.connection import MATCH_OPTIONS
from jacaros.artifacts.kit.ros_artifact import RosArtifact
from jacaros.env.artifact import Out, operation
from jacaros.env.values import Structure
from jacaros.ros.backend import Publisher

ROOMS = ("hallway", "living Room", "kitchen", "bathroom")
"""The rooms by number, in the thesis's words: programs compare and print them."""

CARPET, FLOOR, TUB = "Carpet", "Floor", "Tub"
"""What is cleaned.  The thesis writes "Flor"; its programs only print the word, so ours is the right one."""

BETWEEN_TASKS = 1.0
"""Seconds between two tasks in one room, as in the thesis."""

CLEANING = 2.5
"""Seconds that the cleaning of a room takes, as in the thesis."""

KINDS = ("vacuum", "mop", "scrub")
"""The kinds of tasks."""

Task = tuple[str, str]
"""Kind of a task, and what is cleaned."""

TASKS: tuple[tuple[Task, ...], ...] = (
    (),
    (("vacuum", CARPET),),
    (("mop", FLOOR),),
    (("scrub", TUB), ("mop", FLOOR)),
)
"""The tasks of the rooms, by number."""


def more_rooms(value: object) -> tuple[tuple[str, tuple[Task, ...]], ...]:
    """A list such as ``[room("study", [vacuum("Carpet")])]``: names of rooms, each with its tasks."""
    try:
        return tuple(_room(each) for each in value)  # type: ignore[attr-defined]  # TypeError if it is not a list
    except TypeError:
        raise ValueError("""a list such as [room("study", [vacuum("Carpet")])]""") from None


def _room(value: object) -> tuple[str, tuple[Task, ...]]:
    match value:
        case Structure("room", (str(name), list(tasks))):
            return str(name), tuple(_task(each) for each in tasks)
    raise ValueError(f"""rooms such as room("study", [vacuum("Carpet")]), not {value}""")


def _task(value: object) -> Task:
    match value:
        case Structure(kind, (str(thing),)) if kind in KINDS:
            return kind, str(thing)
    raise ValueError(f"""tasks such as vacuum("Carpet"), of the kinds {", ".join(KINDS)}, not {value}""")


class ArtCleaning(RosArtifact):
    """Tells the tasks of a room and what room comes next.

    Every task is also published as text, such as ``vacuum carpet living_room``, on ``/cleaning/task`` when
    the system has ROS: the embedded world logs it with the robot's true place, and a robot with a tool of the first
    word's name starts it.  An empty text on ``/cleaning/tool`` stops it at the
    end and at the moment of a pause, and its name starts it again when the pause ends.

    Options:
        more_rooms(R): rooms after the thesis's four, with their tasks, such as
            ``[room("study", [vacuum("Carpet")])]``; their numbers are 4, 5, and so on.
        match_timeout(S): how long the first task waits for a subscriber of ``/cleaning/task`` (3 s).
        unmatched(W): what happens when there is none by then: ``warn`` (the default; the task is published all the
            same) or ``fail``, with ``unmatched(Topic)``.

    Properties:
        atRoom(N): number of the room, 0 (hallway) to 3 (bathroom) or that of the last of `more_rooms`.
        vacuum(Object, Room), mop(Object, Room), scrub(Object, Room): the newest task of a kind; texts, empty
            before the first.
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
        """Tell ``atRoom`` anew, though it has not changed."""
        self.update_property("atRoom", self.value("atRoom"))

    @operation(name="whereAmI")
    def give_where_i_am(self, room: Out, name: Out) -> None:
        """Give number and name of the room to the caller."""
        room.set(self.value("atRoom"))
        name.set(self._rooms[self.value("atRoom")])

    @operation(name="updateWhereAmI")
    def update_where_am_i(self) -> None:
        """Go on to the next room; after the last comes the first."""
        self.update_property("atRoom", (self.value("atRoom") + 1) % len(self._rooms))

    @operation(pausable=True)
    async def clean(self, room: int) -> None:
        """Tell the tasks of *room* one after the other, and take the time they need.

        While the intention is suspended the work rests: a robot that has left to recharge mops no floor.
        Fails with ``unknown_room(N)``.
        """
        if not 0 <= room < len(self._rooms):
            self.fail(f"there is no room {room}; rooms are 0 to {len(self._rooms) - 1}", "unknown_room", room)
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
        """Take so many seconds, pauses not counted."""
        while seconds > 0.0:
            await self.sleep(seconds)
            over = self.clock.elapsed
            paused = await self.pause_point()
            # What was paused while the sleep went on is still to be done.
            seconds = round(paused - (self.clock.elapsed - over), 6)

    def _publish(self, task: str) -> None:
        if self._tasks is not None:
            self._tasks.publish(self._tasks.message(data=task))

    def _use(self, tool: str) -> None:
        if self._tools is not None:
            self._tools.publish(self._tools.message(data=tool))
