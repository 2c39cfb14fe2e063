"""Systems in Python programs: an artifact that counts, and a run on the virtual clock."""

from collections.abc import Awaitable, Callable
from typing import Any

import jacaros
from jacaros import Mas
from jacaros.artifacts import Artifact, Out, operation

Test = Callable[..., Awaitable[None]]


class Counter(Artifact):
    """Counts."""

    def init(self, start: int = 0) -> None:
        self.define_property("count", start)
        self.stopped = False

    @operation
    def inc(self, by: int = 1) -> None:
        self.update_property("count", self.value("count") + by)

    @operation
    async def drive(self) -> None:
        try:
            await self.sleep(1000)
        finally:
            self.stopped = True
            self.resources["console"]("counter", "standing")

    @operation
    def double(self, number: int, result: Out) -> None:
        result.set(2 * number)


def run(test: Test, lines: list[str], logs: list[str], **options: Any) -> Mas:
    """Run a test in a system of its own, on the virtual clock."""

    async def main() -> Mas:
        async with Mas(
            seed=1,
            on_print=lambda agent, text: lines.append(f"[{agent}] {text}"),
            on_log=lambda text, level: logs.append(text),
            **options,
        ) as mas:
            await test(mas)
        return mas

    return jacaros.run(main(), clock="fast")
