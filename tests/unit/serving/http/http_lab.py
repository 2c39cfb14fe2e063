"""A run that serves over HTTP, and clients of it."""

import json
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import aclosing, asynccontextmanager
from pathlib import Path
from typing import Any

import httpx

import jacaros
from jacaros import Mas
from jacaros.serving.http.door import Address, HttpDoor
from jacaros.serving.tokens import Tokens

PROGRAM = """
{ offer(goal, deliver(parcel(string), room([kitchen, office])), doc("Bring a parcel to a room."), when_busy(wait)) }
{ offer(goal, count(n(number(0, 10)), next(out(number))), at_most(any)) }
{ offer(goal, guard, when_left(cancel)) }
{ offer(goal, ponder) }
{ offer(goal, reset, role(operator)) }
{ offer(belief, battery(level(number, "Charge in percent."))) }
{ offer(question, double(x(number), y(out(number)))) }
{ offer(tell, closed(room(atom))) }
{ offer(event, delivered(parcel(string))) }
battery(80). secret(42).
double(X, 2 * X).
+!deliver(_, Room) : closed(Room) <- .refuse(closed(Room)).
+!deliver(Parcel, _) <- .wait({+go}); .progress(0.5, "half way"); -+battery(50); .announce(delivered(Parcel)).
+!count(N, N + 1).
+!guard <- .wait(1000000).
+!ponder <- .accept; .fail(no_idea).
+!reset <- -+battery(100).
"""
CALLERS = {
    "anna-0123456789abcdef": ("anna", frozenset({"user"})),
    "bert-0123456789abcdef": ("bert", frozenset({"user"})),
    "wall-0123456789abcdef": ("wall", frozenset({"observer"})),
    "boss-0123456789abcdef": ("boss", frozenset({"operator"})),
}


def token(name: str) -> str:
    """Return the token of a caller."""
    return f"{name}-0123456789abcdef"


class Lab:
    """A run that serves, with one agent, ``bob``.

    Attributes:
        mas: the run.
        door: its server.
        anna: a client of a user.
    """

    def __init__(self, mas: Mas, door: HttpDoor) -> None:
        self.mas, self.door = mas, door
        self.anna = self.client("anna")

    def client(self, name: str = "", **headers: str) -> httpx.AsyncClient:
        """Return a client of a caller."""
        sent = {"Authorization": f"Bearer {token(name)}"} if name else {}
        return httpx.AsyncClient(base_url=self.door.url, headers={**sent, **headers}, timeout=None)

    @asynccontextmanager
    async def events(self, query: str = "", name: str = "anna") -> AsyncIterator[AsyncIterator[Any]]:
        """Open an event stream."""
        async with self.client(name) as client, client.stream("GET", f"/events{query}") as response:
            assert response.status_code == 200, (await response.aread()).decode()
            assert response.headers["content-type"].startswith("text/event-stream")
            lines = response.aiter_lines()
            assert await anext(lines) == ": connected"

            async def found() -> AsyncIterator[Any]:
                async for line in lines:
                    if line.startswith("data: "):
                        yield json.loads(line.removeprefix("data: "))

            async with aclosing(found()) as events:
                yield events


Test = Callable[[Lab], Awaitable[None]]


def serve(
    test: Test, program: str = PROGRAM, address: Address | None = None, clock: Any = "real"
) -> list[str]:
    """Run a test with a run that serves. Return its log."""
    log: list[str] = []

    async def main() -> None:
        async with Mas(on_log=lambda text, _: log.append(text)) as mas:
            mas.add_agent("bob", program)
            lab = Lab(mas, HttpDoor(mas.system, address or Address(), Tokens(CALLERS)))
            async with lab.anna:
                await test(lab)

    jacaros.run(main(), clock=clock)
    return log


def problem(response: httpx.Response, status: int, code: str) -> Any:
    """Check that a response is a problem document. Return it."""
    assert response.headers["content-type"] == "application/problem+json", response.text
    document = response.json()
    assert (response.status_code, document["status"], document["code"]) == (status, status, code), document
    assert {"type", "title", "detail", "reasons"} <= document.keys()
    return document


def free_program(folder: Path) -> Path:
    """Write the program. Return its file."""
    file = folder / "bob.asl"
    file.write_text(PROGRAM, encoding="utf-8")
    return file
