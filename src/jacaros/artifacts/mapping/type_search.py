"""Look up the types that a mapping omits, as soon as another node uses the topic."""

from collections.abc import Callable
from dataclasses import dataclass

from jacaros.artifacts.mapping.declared import Written
from jacaros.artifacts.mapping.host import Host
from jacaros.ros.backend import GraphContents
from jacaros.ros.errors import CapabilityMissing, RosError
from jacaros.ros.waiting import MISSING_AFTER

LOOK = 0.5
"""Seconds between two queries of the graph."""

_EXAMPLES = {"topic": "msg/Type", "service": "srv/Type", "action": "action/Type"}


@dataclass(frozen=True, slots=True)
class Wanted:
    """A topic whose type is needed; *found* receives it."""

    written: Written
    name: str
    found: Callable[[str], None]


def type_in(contents: GraphContents, kind: str, name: str) -> str:
    """Return the type of a topic, service or action by its absolute name; empty if it does not exist."""
    if kind == "service":
        return contents.services.get(name, "")
    if kind == "action":
        return contents.actions.get(name, "")
    topic = contents.topics.get(name)
    return topic.types[0] if topic is not None and topic.types else ""


class TypeSearch:
    """Query the graph until all types are known.

    Args:
        host: the artifact.
    """

    def __init__(self, host: Host) -> None:
        self._host = host
        self._wanted: list[Wanted] = []

    def want(self, written: Written, found: Callable[[str], None]) -> None:
        """Call *found* with the type of a topic when it is known."""
        name = self._host.ros.resolve(self._host.robot_topic(written.text))
        self._wanted.append(Wanted(written, name, found))

    def begin(self) -> None:
        """Query until everything is known; a process of the artifact."""
        if self._wanted:
            self._host.start(self._host.run_process, self._search)

    async def _search(self) -> None:
        host, began = self._host, self._host.clock.elapsed
        told, missed = False, False
        while self._wanted:
            contents = await self._contents()
            if contents is None:
                return
            self._take(contents)
            if self._wanted and not told:
                told = True
                for each in self._wanted:
                    host.log(f"waiting for topic {each.name}, to find its type")
            if self._wanted and not missed and host.clock.elapsed - began >= MISSING_AFTER:
                missed = True
                for each in self._wanted:
                    self._miss(each)
            if self._wanted:
                await host.sleep(LOOK)

    async def _contents(self) -> GraphContents | None:
        """Return the contents of the graph; empty while it cannot be queried, None if it never can."""
        try:
            return await self._host.step(self._host.ros.contents())
        except CapabilityMissing as error:
            for each in self._wanted:
                self._host.report_once(
                    each, each.written.place, str(error), "write the type: type: package/msg/Type"
                )
            return None
        except RosError:
            return GraphContents()

    def _take(self, contents: GraphContents) -> None:
        for each in list(self._wanted):
            if found := type_in(contents, "topic", each.name):
                self._wanted.remove(each)
                each.found(found)

    def _miss(self, wanted: Wanted) -> None:
        self._host.report_once(
            wanted,
            wanted.written.place,
            f"no node uses topic {wanted.name}, so its type is unknown; still waiting",
            "start the node that publishes it, or write its type: type: package/msg/Type",
        )


async def ask_type(host: Host, kind: str, written: Written) -> str:
    """Return the type of a topic, service or action that an operation uses; a step boundary.

    Raises:
        OperationFailed: ``type_unknown(Name)``.
    """
    name = host.ros.resolve(host.robot_topic(written.text))
    patience = host.clock.elapsed + MISSING_AFTER
    try:
        # A node that has just joined needs some time to discover its graph.
        while not (found := type_in(await host.step(host.ros.contents()), kind, name)):
            if host.clock.elapsed >= patience:
                break
            await host.sleep(LOOK)
    except RosError as error:
        host.fail(str(error), "type_unknown", name)
    if not found:
        where = host.mapping.where(written.place)
        help = f"start the node that offers it, or write its type in {where}: type: package/{_EXAMPLES[kind]}"
        host.fail(f"unknown {kind} {name}, so its type is unknown; {help}", "type_unknown", name)
    return found
