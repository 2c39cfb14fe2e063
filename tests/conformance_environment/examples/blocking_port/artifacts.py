"""The artifacts of this case, written from its spec.md."""

import asyncio

from jacaros.artifacts import Artifact, Out, operation


class Port(Artifact):
    """Receives what is delivered."""

    def init(self) -> None:
        self._messages: asyncio.Queue[tuple[str, int]] = asyncio.Queue()
        self.define_property("state", "idle")

    @operation
    async def receive(self, text: Out, number: Out) -> None:
        self.update_property("state", "listening")
        message = await self.step(self._messages.get())
        self.update_property("state", "idle")
        text.set(message[0])
        number.set(message[1])

    @operation
    def deliver(self, text: str, number: int) -> None:
        self._messages.put_nowait((text, number))
