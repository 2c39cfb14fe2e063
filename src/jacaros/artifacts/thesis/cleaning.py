"""``ArtCleaning``: the household of the thesis, which says what is to be done in which room."""

from typing import ClassVar

from jacaros.artifacts.kit.connection import MATCH_OPTIONS
from jacaros.artifacts.kit.ros_artifact import RosArtifact
from jacaros.env.artifact import Out, operation
from jacaros.ros.backend import Publisher

ROOMS = ("hallway", "living Room", "kitchen", "bathroom")
"""The rooms by number, in the thesis's words: programs compare and print them."""

CARPET, FLOOR, TUB = "Carpet", "Floor", "Tub"
"""What is cleaned.  The thesis writes "Flor"; its programs only print the word, so ours is the right one."""

BETWEEN_TASKS = 1.0
"""Seconds between two tasks in one room, as in the thesis."""

CLEANING = 2.5
"""Seconds that the cleaning of a room takes, as in the thesis."""

TASKS = {
    0: (),
    1: (("vacuum", CARPET),),
    2: (("mop", FLOOR),),
    3: (("scrub", TUB), ("mop", FLOOR)),
}


class ArtCleaning(RosArtifact):
    """Tells the tasks of a room and what room comes next.

    Every task is also published as text, such as ``vacuum carpet living_room``, on ``/cleaning/task`` when
    the system has ROS: the embedded world logs it with the robot's true place, and a robot with a tool of the first
    word's name starts it.  An empty text on ``/cleaning/tool`` stops it at the
    end and at the moment of a pause, and its name starts it again when the pause ends.

    Options:
        match_timeout(S): how long the first task waits for a subscriber of ``/cleaning/task`` (3 s).
        unmatched(W): what happens when there is none by then: ``warn`` (the default; the task is published all the
            same) or ``fail``, with ``unmatched(Topic)``.

    Properties:
        atRoom(N): number of the room, 0 (hallway) to 3 (bathroom).
        vacuum(Object, Room), mop(Object, Room), scrub(Object, Room): the newest task of a kind; texts, empty
            before the first.
    """

    known_options: ClassVar = MATCH_OPTIONS
    _tasks: Publisher | None = None
    _tools: Publisher | None = None

    def open(self) -> None:
        """Define the properties; the robot begins in the hallway."""
        self.define_property("atRoom", 0)
        for task in ("vacuum", "mop", "scrub"):
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
        name.set(ROOMS[self.value("atRoom")])

    @operation(name="updateWhereAmI")
    def update_where_am_i(self) -> None:
        """Go on to the next room; after the last comes the first."""
        self.update_property("atRoom", (self.value("atRoom") + 1) % len(ROOMS))

    @operation(pausable=True)
    async def clean(self, room: int) -> None:
        """Tell the tasks of *room* one after the other, and take the time they need.

        While the intention is suspended the work rests: a robot that has left to recharge mops no floor.
        Fails with ``unknown_room(N)``.
        """
        if room not in TASKS:
            self.fail(f"there is no room {room}; rooms are 0 to {len(ROOMS) - 1}", "unknown_room", room)
        if self._tasks is not None and TASKS[room]:
            await self.matched(self._tasks)
        tool = ""
        self.current.on_pause(lambda: self._use(""))
        self.current.on_resume(lambda: self._use(tool))
        try:
            for number, (task, thing) in enumerate(TASKS[room]):
                if number:
                    await self._work(BETWEEN_TASKS)
                tool = task
                self.update_property(task, thing, ROOMS[room])
                self._publish(f"{task} {thing} {ROOMS[room].replace(' ', '_')}".lower())
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
