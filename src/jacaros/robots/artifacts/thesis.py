"""Artifacts of the thesis's scenarios: the household, percepts as texts, the ROS tutorial."""

import math
from typing import Any, ClassVar

from jacaros.artifacts.env.artifact import Out, operation
from jacaros.artifacts.env.values import Structure
from jacaros.robots.kit.connection import MATCH_OPTIONS
from jacaros.robots.kit.options import positive, text, yes_or_no
from jacaros.robots.kit.reading import READING_OPTIONS, Reading
from jacaros.robots.kit.ros_artifact import RosArtifact
from jacaros.robots.ros.backend import Sample
from jacaros.robots.ros.node import Publisher
from jacaros.robots.ros.services import Client
from jacaros.robots.streams import ReadingPolicy

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
NO_MORE: tuple[tuple[str, tuple[Task, ...]], ...] = ()
"""The usual value of the option ``more_rooms``."""

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
        more = self.option("more_rooms", NO_MORE)
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


# ``ArtPerception``: percepts that another program sends as texts.


class ArtPerception(RosArtifact):
    """Shows the texts of ``/jason/perception`` (``perception_msgs/msg/perception``, a list of texts).

    Each message replaces the percepts of the previous one; an unchanged text causes no event.

    Options:
        topic(T): another topic.
        split(true): show the parts between commas, with numbers as numbers.

    Properties:
        perception(Text): one for each text of the newest message, such as ``"box1,1.0,2.0,3.1"``; with `split`
            ``perception("box1", 1.0, 2.0, 3.1)``.

    Signals:
        tick_perception: `getPerception` was called.
    """

    known_options: ClassVar = {"topic": text, "split": yes_or_no}

    def open(self) -> None:
        """Subscribe; there are no percepts before the first message."""
        self._texts: list[str] = []
        topic = self.option("topic", "jason/perception")
        self.subscription(topic, "perception_msgs/msg/perception", self._take)

    def _take(self, sample: Sample) -> None:
        self._texts = [str(each) for each in sample.message.perception]
        split = self.option("split", False)
        elements = [tuple(map(_value, each.split(","))) if split else (each,) for each in self._texts]
        self.start(self.show_elements, "perception", elements, cause=sample.cause)

    @operation(name="getPerception")
    def get_perception(self) -> None:
        """Signal ``tick_perception``; the properties are always current."""
        self.signal("tick_perception")

    @operation(name="getPerception")
    def give_perception(self, texts: Out) -> None:
        """Give the texts of the newest message to the caller, as a list; empty before the first."""
        texts.set(self._texts)


def _value(part: str) -> str | float:
    """Return a number if the text is a finite one."""
    try:
        number = float(part)
    except ValueError:
        return part.strip()
    return number if math.isfinite(number) else part.strip()


# ``ArtTutorial``: the talker and the adding service of the ROS tutorials.


class ArtTutorial(RosArtifact):
    """Shows the messages of ``/chatter`` and adds numbers with the service ``add_two_ints``.

    The robot's name is the prefix of the topic and the properties, not of the service, as in the thesis.

    Options:
        mode, rate, expire: see `ReadingPolicy`; `latest_only` is false here because every message counts.
        service(Name): another name of the service.
        timeout(S): how long an addition may take (10 s).

    Properties:
        chatter(Text): the newest message, empty before the first.
        twoIntsSum(S): the result of the last addition, 0 before the first.
    """

    known_options: ClassVar = {**READING_OPTIONS, "service": text, "timeout": positive}
    robot_in_properties = True

    _chatter: Reading
    _adder: Client

    def open(self) -> None:
        """Define the properties, subscribe, and look for the service without waiting for it."""
        name = self.robot_property("chatter")
        self.define_property(self.robot_property("twoIntsSum"), 0)
        self._chatter = self.reading(name, ReadingPolicy.from_options(self.options, latest_only=False), "")
        self.subscription("chatter", "std_msgs/msg/String", self._hear)
        service = self.option("service", "/add_two_ints")
        self._adder = self.client(service, "example_interfaces/srv/AddTwoInts")

    def _hear(self, sample: Sample) -> None:
        self._chatter.take((str(sample.message.data),), sample.cause)

    @operation(name="getCurrentMessage")
    async def get_current_message(self) -> None:
        """Update the property ``chatter`` to the newest message; fails with ``no_message(5)`` if none exists for 5
        s."""
        await self.refresh(self.robot_property("chatter"), self._chatter, "no_message")

    @operation
    async def sum(self, a: int, b: int) -> None:
        """Add with the service and show the result in ``twoIntsSum``.

        Fails with ``service_unavailable(Name)``, ``service_timeout(Seconds)`` or ``service_failed(Name)``.
        """
        self.update_property(self.robot_property("twoIntsSum"), await self._added(a, b))

    @operation(name="sum")
    async def give_sum(self, a: int, b: int, result: Out) -> None:
        """Add with the service, show the result and give it to the caller."""
        total = await self._added(a, b)
        self.update_property(self.robot_property("twoIntsSum"), total)
        result.set(total)

    async def _added(self, a: int, b: int) -> int:
        response: Any = await self.call(self._adder, self.option("timeout", 10.0), a=a, b=b)
        return int(response.sum)
