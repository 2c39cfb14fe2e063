"""Clients over MCP: a session for each caller, and the goals it pursues."""

import asyncio
import time
from collections.abc import Awaitable, Callable, Coroutine, Mapping
from contextlib import suppress
from typing import Any, TypeVar

from jacaros.agents.language.offers import Offer
from jacaros.serving.callers import Caller, RequestError
from jacaros.serving.crossing import Crossing, Outbox
from jacaros.serving.goals import RequestedGoal
from jacaros.serving.mcp.tools import OfferedTool, named_tools
from jacaros.serving.service import Event, Service, Session

T = TypeVar("T")
LOOK = 1.0
"""Seconds between looks at what an agent does for a goal whose client wants to know."""
Report = Callable[[float, float | None, str | None], Awaitable[None]]
"""Reports progress: how far, of how much, and what the agent does."""


class Client:
    """A caller over MCP. Methods that begin with an underscore belong to the loop of the run.

    Args:
        caller: who it is.
        crossing: the way to the run.
        service: the service of the run.

    Attributes:
        left: whether its connection has ended. The end of a request then is not a wish to cancel its goal.
    """

    def __init__(self, caller: Caller, crossing: Crossing, service: Service) -> None:
        self.caller, self.left = caller, False
        self._crossing, self._service = crossing, service
        self._session: Session | None = None
        self._tools: dict[str, OfferedTool] = {}
        self._busy, self._seen = 0, time.monotonic()

    # ---- presence

    def came(self) -> None:
        """A request has come."""
        self._busy += 1

    def went(self) -> None:
        """The connection of a request has ended."""
        self._busy -= 1
        self._seen = time.monotonic()

    def is_gone(self, lease: float) -> bool:
        """Whether it has had no connection for some seconds."""
        return not self._busy and time.monotonic() - self._seen > lease

    async def leave(self) -> None:
        """End its session."""
        self.left = True
        await self._crossing.call(self._close)

    def _close(self) -> None:
        if self._session is not None:
            self._session.close()

    def _opened(self) -> Session:
        if self._session is None or self._session.closed:
            self._session = self._service.open(self.caller)
        return self._session

    # ---- requests

    async def do(self, request: Callable[[Session], T]) -> T:
        """Call a function with the session, on the loop of the run."""
        return await self._crossing.call(lambda: request(self._opened()))

    async def wait(self, request: Callable[[Session], Coroutine[Any, Any, T]]) -> T:
        """Await a coroutine function with the session, on the loop of the run."""

        async def start() -> T:
            return await request(self._opened())

        return await self._crossing.wait(start)

    async def offered(self) -> list[tuple[str, Offer]]:
        """Return agents, and what they offer to the caller."""
        return await self.do(
            lambda session: [(agent, each) for agent in session.agents() for each in session.offers(agent)]
        )

    async def tools(self) -> Mapping[str, OfferedTool]:
        """Return the tools of the agents by name."""
        self._tools = named_tools(await self.offered())
        return self._tools

    async def tool(self, name: str) -> OfferedTool | None:
        """Return the tool with a name, or None."""
        if name not in self._tools:
            await self.tools()
        return self._tools.get(name)

    async def pursue(
        self, tool: OfferedTool, arguments: Mapping[str, Any], report: Report | None, patience: float | None
    ) -> dict[str, Any]:
        """Give an agent a goal, and wait for its end. Return its data.

        Args:
            tool: the goal.
            arguments: its arguments.
            report: reports progress, if the client wants to know.
            patience: seconds after which the goal continues without this request; None for no limit.

        Raises:
            RequestError: the goal is not given.
        """
        pursuit = Pursuit(self, tool, arguments)
        pursuing = asyncio.create_task(self.wait(pursuit.run))
        reporting = None if report is None else asyncio.create_task(self._report(pursuit, report))
        try:
            await asyncio.wait({pursuing}, timeout=patience)
            if pursuing.done():
                return await pursuing
            pursuit.detached = True
            return await self.do(lambda _: pursuit.data())
        finally:
            pursuing.cancel()
            if reporting is not None:
                reporting.cancel()

    async def _report(self, pursuit: "Pursuit", report: Report) -> None:
        news: Outbox[None] = Outbox(asyncio.get_running_loop())
        stop = await self.do(lambda session: session.listen(lambda event: pursuit.heard(event, news)))
        shown, last = 0.0, None
        try:
            while True:
                with suppress(TimeoutError):
                    async with asyncio.timeout(LOOK):
                        await news.take()
                now = await self.do(lambda _: pursuit.progress())
                if now is None or now == last:
                    continue
                fraction, last = now[0], now
                shown = max(fraction or 0.0, shown + 1e-6)  # clients expect it to increase
                await report(shown, None if fraction is None else 1.0, now[1] or None)
        finally:
            with suppress(RequestError):
                self._crossing.post(stop)

    async def watch(self, beliefs: Mapping[str, tuple[str, str]], changed: Outbox[str]) -> Callable[[], None]:
        """Put the address of each belief that changes into an outbox, and "" when agents start or end.

        Returns:
            A function that ends this.

        Args:
            beliefs: agents and names of the beliefs, by address.
            changed: where to put the addresses.
        """

        def begin(session: Session) -> Callable[[], None]:
            ends = [_hear_agents(session, changed)]

            def stop() -> None:
                for end in ends:
                    end()

            try:
                for uri, (agent, name) in beliefs.items():
                    ends.append(_watch(session, agent, name, uri, changed))
            except RequestError:
                stop()
                raise
            return stop

        stop = await self.do(begin)

        def end() -> None:
            with suppress(RequestError):  # the run has ended
                self._crossing.post(stop)

        return end


def _hear_agents(session: Session, changed: Outbox[str]) -> Callable[[], None]:
    def hear(event: Event) -> None:
        if event["event"] in ("agent_started", "agent_ended"):
            changed.put("", "")

    return session.listen(hear)


def _watch(session: Session, agent: str, name: str, uri: str, changed: Outbox[str]) -> Callable[[], None]:
    begun = False

    def tell(_: object) -> None:
        if begun:  # the first call only says how it is now
            changed.put(uri, uri)

    end = session.watch(agent, name, tell)
    begun = True
    return end


class Pursuit:
    """A goal that a request waits for. All methods belong to the loop of the run.

    Args:
        client: who gives it.
        tool: the goal.
        arguments: its arguments.

    Attributes:
        detached: whether the goal continues when the request ends.
    """

    def __init__(self, client: Client, tool: OfferedTool, arguments: Mapping[str, Any]) -> None:
        self._client, self._tool, self._arguments = client, tool, arguments
        self.detached = False
        self._goal: RequestedGoal | None = None

    async def run(self, session: Session) -> dict[str, Any]:
        """Give the goal, and wait for its end. Return its data."""
        goal = self._goal = session.achieve(self._tool.agent, self._tool.offer.key, self._arguments)
        try:
            await goal.wait()
        except asyncio.CancelledError:
            if not (self.detached or self._client.left):
                session.cancel(goal.id)
            raise
        return goal.data()

    def data(self) -> dict[str, Any]:
        """Return the data of the goal."""
        if self._goal is None:
            raise RequestError("unresponsive", "the run has not taken the goal yet; ask again")
        return self._goal.data()

    def heard(self, event: Event, news: Outbox[None]) -> None:
        """Take note of an event."""
        if self._goal is not None and event.get("id") == self._goal.id:
            news.put(None, "progress")

    def progress(self) -> tuple[float | None, str] | None:
        """Return how far the goal is, and what the agent does; None before it is given, and after its end."""
        goal = self._goal
        if goal is None or goal.over:
            return None
        return goal.progress, goal.note or goal.doing() or goal.state
