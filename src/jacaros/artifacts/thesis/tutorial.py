"""``ArtTutorial``: the talker and the adding service of the ROS tutorials."""

from typing import Any, ClassVar

from jacaros.artifacts.env.artifact import Out, operation
from jacaros.artifacts.kit.options import positive, text
from jacaros.artifacts.kit.reading import READING_OPTIONS, Reading, ReadingPolicy
from jacaros.artifacts.kit.ros_artifact import RosArtifact
from jacaros.ros.node import Sample
from jacaros.ros.services import Client


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
        service = str(self.options.get("service", "/add_two_ints"))
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
        timeout = self.options.get("timeout", 10.0)
        assert isinstance(timeout, float)
        response: Any = await self.call(self._adder, timeout, a=a, b=b)
        return int(response.sum)
