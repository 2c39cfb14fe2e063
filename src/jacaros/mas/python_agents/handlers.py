"""The handlers of a Python agent: ``on_message``, ``on_signal``, ``on_property``."""

import asyncio
from collections.abc import Callable, Coroutine
from functools import partial
from inspect import isawaitable
from typing import Any

from jacaros.agents.python.agent import ReceivedMessage, overridden
from jacaros.agents.python.python_agent import PythonAgent
from jacaros.artifacts.presence.session import Session
from jacaros.mas.python_agents.messaging import Messaging
from jacaros.mas.python_agents.task_activity import TaskActivity


class Handlers:
    """Calls the handlers of an agent in turn, in the order of events.

    Args:
        agent: the agent.
        mail: its messages.
        task_activity: counts waits.
        start: runs a coroutine of the agent.
    """

    def __init__(
        self,
        agent: PythonAgent,
        mail: Messaging,
        task_activity: TaskActivity,
        start: Callable[[Coroutine[Any, Any, Any]], object],
    ) -> None:
        self._mail, self._task_activity, self._start = mail, task_activity, start
        self._on_message = overridden(agent, PythonAgent, "on_message")
        self._on_signal = overridden(agent, PythonAgent, "on_signal")
        self._on_property = overridden(agent, PythonAgent, "on_property")
        self._waiting: asyncio.Queue[Callable[[], Any]] = asyncio.Queue()

    @property
    def wanted(self) -> bool:
        """Whether the agent has handlers."""
        return any((self._on_message, self._on_signal, self._on_property))

    async def serve(self) -> None:
        """Call them until the agent ends."""
        if self._on_message is not None:
            self._start(self._read())
        while True:
            with self._task_activity.waiting():
                handle = await self._waiting.get()
            done = handle()
            if isawaitable(done):
                await done

    def listen(self, session: Session) -> None:
        """Record what the session of the agent perceives, from its beginning."""
        if self._on_signal is not None:
            on_signal = self._on_signal
            session.on_signal(lambda signal: self._waiting.put_nowait(partial(on_signal, signal)))
        if self._on_property is not None:
            on_change = self._on_property
            session.on_change(lambda change: self._waiting.put_nowait(partial(on_change, change)))

    async def _read(self) -> None:
        while True:
            message = await self._mail.next_message(None)
            self._waiting.put_nowait(partial(self._handle, message))

    async def _handle(self, message: ReceivedMessage) -> None:
        assert self._on_message is not None
        answer = self._on_message(message)
        if isawaitable(answer):
            answer = await answer
        if message.is_question and not message.answered:
            message.reply(answer)
