"""Let an agent add and remove beliefs with a million generated names, and compare its memory before and after.

    python benchmarks/mind/names.py [NAMES]

*in turn* forgets each name before it makes the next one; *together* believes a tenth of the names before it forgets one.
"""

import asyncio
import gc
import subprocess
import sys
import tracemalloc
from pathlib import Path

from jacaros import Mas

USES = {
    "atoms in turn": ("obj_{}", "+seen(T); -seen(T)", ""),
    "beliefs in turn": ("obj_{}(1)", "+T; -T", ""),
    "goals in turn": ("obj_{}", "!T", ""),
    "beliefs together": ("obj_{}(1)", "+T", "-T"),
}
FIRST, STEPS = 5_000, 10


def program(use: str) -> str:
    """Return a program whose goal ``names(F, L)`` uses the names from number F to L."""
    name, step, afterwards = USES[use]
    before, _, after = name.partition("{}")
    make = f'.concat("{before}", I, "{after}", S); .term2string(T, S)'
    loops = [f"for (.range(I, F, L)) {{ {make}; {each} }}" for each in (step, afterwards) if each]
    return f"+!names(F, L) <- {'; '.join(loops)}. +!G."


def resident() -> float:
    """Return the resident memory of this process in MB (Linux)."""
    return int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1]) * 4096 / 1e6


def of_python() -> float:
    """Return the memory of all Python objects in MB."""
    return tracemalloc.get_traced_memory()[0] / 1e6


async def measure(use: str, number: int) -> None:
    """Print the resident memory around *number* names, and that of Python objects around a tenth of them."""
    async with Mas(seed=1) as mas:
        agent = mas.add_agent("a", program(use))
        last = FIRST
        await agent.achieve(f"names(1, {last})")
        for what, size, names in (
            ("resident", resident, number),
            ("Python objects", of_python, number // 10),
        ):
            if size is of_python:
                tracemalloc.start()
                last += await _use(agent, last, FIRST)
            gc.collect()
            before = top = size()
            for _ in range(STEPS):
                last += await _use(agent, last, names // STEPS)
                top = max(top, size())
            gc.collect()
            print(
                f"{use}, {names:,} names, {what}: {before:.1f} MB before, {size():.1f} MB after, {top:.1f} MB at most"
            )


async def _use(agent: object, last: int, number: int) -> int:
    await agent.achieve(f"names({last + 1}, {last + number})")  # type: ignore[attr-defined]
    return number


def main(arguments: list[str]) -> None:
    """Measure each use in a process of its own."""
    if len(arguments) == 2:
        asyncio.run(measure(arguments[0], int(arguments[1])))
        return
    for use in USES:
        subprocess.run([sys.executable, __file__, use, *(arguments or ["1000000"])], check=True)


if __name__ == "__main__":
    main(sys.argv[1:])
