"""Runs on the virtual clock with their history."""

from collections.abc import Callable
from typing import Any

import jacaros
from jacaros import Mas


def records_of(
    programs: dict[str, str],
    seconds: float = 10.0,
    during: Callable[[Mas], None] | None = None,
    **options: Any,
) -> list[tuple[float, str, dict[str, Any]]]:
    """The records of a run: agents by name, with their programs; *during* is called when half the time is over,
    *project* is a project file with further agents."""
    found: list[tuple[float, str, dict[str, Any]]] = []

    async def main() -> None:
        async with Mas(
            seed=1, on_print=lambda agent, text: None, on_log=lambda *line: None, **options
        ) as mas:
            history = mas.system.history()
            history.listen(lambda t, event, data: found.append((t, event, dict(data))))
            history.start()
            for name, program in programs.items():
                mas.add_agent(name, program)
            clock = mas.system.clock
            await clock.sleep(seconds / 2)
            if during is not None:
                during(mas)
            await clock.sleep(seconds / 2)

    jacaros.run(main(), clock="fast")
    return found


def of(records: list[tuple[float, str, dict[str, Any]]], event: str) -> list[dict[str, Any]]:
    """The data of the records of one kind."""
    return [data for _, kind, data in records if kind == event]
