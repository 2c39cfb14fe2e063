"""Two systems in one process, on one loop or in two threads: each with its own state."""

import asyncio
import sys
import threading
from pathlib import Path

from jacaros import Mas

PROGRAM = 'name("a"). +!bad <- ?name(Y); X = Y + 1; .print(X).'


async def test_warnings_go_to_the_log_of_the_system_whose_agent_they_concern() -> None:
    logs: dict[str, list[str]] = {"ann": [], "bob": []}
    systems = [Mas(on_log=lambda text, _, log=log: log.append(text)) for log in logs.values()]  # type: ignore[misc]
    async with systems[0], systems[1]:
        agents = [mas.add_agent(name, PROGRAM) for mas, name in zip(systems, logs, strict=True)]
        for agent in agents:
            await agent.achieve("bad")
    assert {name: len(log) for name, log in logs.items()} == {"ann": 1, "bob": 1}
    assert all(log[0].startswith(f"[{name}] warning: operand of `+`") for name, log in logs.items())


FUNCTION = """
from jacaros import arithmetic_function

@arithmetic_function("my.own")
def own(x):
    return {number}
"""
ROUNDS = """
{{ register_function("your.own", 1, "own") }}
own(_, {number}).
+!rounds(0) <- .print("end").
+!rounds(N)
  <- T = [my.own(X), your.own(X) + 0]; X = N;
     for (.member(Y, T)) {{ if (Y \\== {number}) {{ .print(N, ": ", Y) }} }};
     !rounds(N - 1).
"""


def test_systems_in_two_threads_compute_with_functions_of_their_own(tmp_path: Path) -> None:
    printed: dict[int, list[str]] = {1: [], 2: []}
    begin = threading.Barrier(2)

    def system(number: int) -> None:
        folder = tmp_path / str(number)
        folder.mkdir()
        (folder / "my.py").write_text(FUNCTION.format(number=number))

        async def main() -> None:
            async with Mas(folder=folder, on_print=lambda _, text: printed[number].append(text)) as mas:
                agent = mas.add_agent("ann", ROUNDS.format(number=number))
                begin.wait(10)
                await agent.achieve("rounds(10000)")

        asyncio.run(main())

    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-5)
    try:
        threads = [threading.Thread(target=system, args=(number,)) for number in printed]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    finally:
        sys.setswitchinterval(interval)
    assert printed == {1: ["end"], 2: ["end"]}
