"""Systems in Python programs: an artifact that counts, and a run on the virtual clock."""

from collections.abc import Awaitable, Callable

import jacaros
from jacaros import Mas
from jacaros.artifacts import Artifact, Out, operation

Test = Callable[[Mas], Awaitable[None]]


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


def run(test: Test, lines: list[str] | None = None, logs: list[str] | None = None, **options: object) -> Mas:
    """Run a test in a system of its own, on the virtual clock."""

    def printed(agent: str, text: str) -> None:
        if lines is not None:
            lines.append(f"[{agent}] {text}")

    def logged(text: str, level: str) -> None:
        if logs is not None:
            logs.append(text)

    async def main() -> Mas:
        async with Mas(seed=1, on_print=printed, on_log=logged, **options) as mas:  # type: ignore[arg-type]
            await test(mas)
        return mas

    return jacaros.run(main(), clock="fast")
