"""Two systems on one loop: each has what is its own."""

import asyncio

from jacaros import Mas

PROGRAM = 'name("a"). +!bad <- ?name(Y); X = Y + 1; .print(X).'


def test_warnings_go_to_the_log_of_the_system_whose_agent_they_concern() -> None:
    logs: dict[str, list[str]] = {"ann": [], "bob": []}

    async def main() -> None:
        systems = [Mas(on_log=lambda text, _, log=log: log.append(text)) for log in logs.values()]  # type: ignore[misc]
        async with systems[0], systems[1]:
            agents = [mas.add_agent(name, PROGRAM) for mas, name in zip(systems, logs, strict=True)]
            for agent in agents:
                await agent.achieve("bad")

    asyncio.run(main())
    assert {name: len(log) for name, log in logs.items()} == {"ann": 1, "bob": 1}
    assert all(log[0].startswith(f"[{name}] warning: an operand of '+'") for name, log in logs.items())
