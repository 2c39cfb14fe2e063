"""Event streams over HTTP: server-sent events, WebSockets, slow and dead clients."""

import asyncio
import json
import sys
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import httpx
import pytest
import websockets
from http_lab import PROGRAM, Lab, problem, serve, token

from jacaros.serving import remote
from jacaros.serving.http import clients, protocol
from jacaros.serving.http.app import messages
from jacaros.serving.http.clients import Stream

sys.path.insert(0, str(Path(__file__).parents[2] / "look"))
from devtools import chromium, needs_chromium

PARCEL = {"parcel": "p1", "room": "kitchen"}
QUERY = "?beliefs=bob.battery"


async def deliver(lab: Lab) -> None:
    given = await lab.anna.post("/agents/bob/goals/deliver", json=PARCEL)
    assert given.status_code == 201
    lab.mas.agent("bob").add_belief("go")


def is_complete(events: list[Any]) -> bool:
    """Return whether a delivery has ended, was announced, and the battery is as it was afterwards."""
    states = [each.get("state") for each in events]
    kinds = [each["event"] for each in events]
    return (
        "achieved" in states
        and "announced" in kinds
        and [{"level": 50}] in [e.get("beliefs") for e in events]
    )


@pytest.mark.parametrize("clock", ["real", "fast"])
def test_a_stream_tells_of_goals_announced_events_and_beliefs(clock: str) -> None:
    async def test(lab: Lab) -> None:
        async with lab.events(QUERY) as events:
            heard = [await anext(events)]
            assert heard[0] == {
                "event": "belief",
                "agent": "bob",
                "name": "battery",
                "beliefs": [{"level": 80}],
            }
            await deliver(lab)
            while not is_complete(heard):
                heard.append(await anext(events))
        states = [each["state"] for each in heard if each["event"] == "goal"]
        assert list(dict.fromkeys(states)) == ["running", "achieved"]
        announced = next(each for each in heard if each["event"] == "announced")
        assert (announced["name"], announced["arguments"]) == ("delivered", {"parcel": "p1"})

    serve(test, clock=clock)


def test_a_new_stream_begins_with_the_goals_that_have_not_ended() -> None:
    async def test(lab: Lab) -> None:
        given = (await lab.anna.post("/agents/bob/goals/guard")).json()
        async with lab.events() as first, lab.events() as second:
            for events in (first, second):
                assert (await anext(events))["id"] == given["id"]
        async with lab.events(name="bert") as events:
            await lab.anna.delete(f"/goals/{given['id']}")
            await deliver(lab)
            assert (await anext(events))["event"] == "announced"

    serve(test)


def test_a_websocket_tells_the_same() -> None:
    async def test(lab: Lab) -> None:
        url = f"{lab.door.url.replace('http', 'ws')}/events{QUERY}"
        headers = {"Authorization": f"Bearer {token('anna')}"}
        async with websockets.connect(url, additional_headers=headers) as socket:
            heard = [json.loads(await socket.recv())]
            await socket.send("ignored")
            await deliver(lab)
            while not is_complete(heard):
                heard.append(json.loads(await socket.recv()))
        async with websockets.connect(f"{url}&access_token={token('wall')}") as socket:
            assert json.loads(await socket.recv())["beliefs"] == [{"level": 50}]
        for wrong, status in ((url, 401), (f"{url},bob.secret&access_token={token('anna')}", 404)):
            with pytest.raises(websockets.InvalidStatus) as refused:
                await websockets.connect(wrong)
            response = refused.value.response
            assert response.status_code == status
            assert json.loads(response.body)["status"] == status

    serve(test)


def test_streams_watch_the_beliefs_of_an_agent_that_starts_again() -> None:
    async def test(lab: Lab) -> None:
        url = f"{lab.door.url.replace('http', 'ws')}/events{QUERY}&access_token={token('anna')}"

        async def until(level: int, hear: Callable[[], Awaitable[Any]]) -> None:
            while (await hear()).get("beliefs") != [{"level": level}]:
                pass

        async with asyncio.timeout(30), lab.events(QUERY) as events, websockets.connect(url) as socket:
            both = (lambda: anext(events)), (lambda: _next_of(socket))
            for hear in both:
                await until(80, hear)
            lab.mas.agent("bob").kill()
            lab.mas.add_agent("bob", PROGRAM.replace("battery(80)", "battery(70)"))
            for hear in both:
                await until(70, hear)
            lab.mas.agent("bob").add_belief("battery", 60)
            lab.mas.agent("bob").remove_belief("battery", 70)
            for hear in both:
                await until(60, hear)

    serve(test)


async def _next_of(socket: websockets.ClientConnection) -> Any:
    return json.loads(await socket.recv())


@needs_chromium
def test_a_browser_hears_events() -> None:
    async def test(lab: Lab) -> None:
        address = f"/events{QUERY}&access_token={token('anna')}"
        async with chromium() as page:
            await page.open(f"{lab.door.url}/goals")
            await page.evaluate(
                f"window.heard = []; new EventSource({address!r}).onmessage = (e) => heard.push(JSON.parse(e.data))"
            )
            await page.wait_for("heard.length === 1")
            given = await page.evaluate(
                "fetch('/agents/bob/goals/deliver', {method: 'POST', body: JSON.stringify("
                f"{json.dumps(PARCEL)}), headers: {{Authorization: 'Bearer {token('anna')}'}}}}).then((r) => r.status)"
            )
            assert given == 201
            lab.mas.agent("bob").add_belief("go")
            await page.wait_for("heard.some((each) => each.state === 'achieved' && each.progress === 0.5)")
            await page.wait_for("heard.some((each) => each.beliefs?.[0].level === 50)")
            # A page of another site cannot even ask.
            await page.open("data:text/html,")
            failed = await page.evaluate(f"fetch({lab.door.url + address!r}).catch((error) => 'failed')")
            assert failed == "failed"

    serve(test)


@pytest.mark.parametrize("way", ["stream", "waiting"])
def test_goals_of_a_killed_client_end_as_declared(way: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(remote, "LEASE", 0.3)

    async def test(lab: Lab) -> None:
        address = httpx.URL(lab.door.url)
        reader, writer = await asyncio.open_connection(address.host, address.port)
        head = f"Host: localhost\r\nAuthorization: Bearer {token('anna')}\r\n"
        if way == "stream":
            writer.write(f"GET /events HTTP/1.1\r\n{head}\r\n".encode())
            await reader.readuntil(b": connected")
            for name in ("guard", "deliver"):
                assert (
                    await lab.anna.post(f"/agents/bob/goals/{name}", json=PARCEL if name == "deliver" else {})
                ).is_success
            await asyncio.sleep(0)
        else:
            await lab.anna.post("/agents/bob/goals/deliver", json=PARCEL)
            writer.write(f"POST /agents/bob/goals/guard HTTP/1.1\r\n{head}Prefer: wait=60\r\n\r\n".encode())
        async with lab.client("boss") as boss:

            async def states() -> dict[str, str]:
                goals = (await boss.get("/goals")).json()["goals"]
                return {each["goal"]: each["state"] for each in goals}

            while (await states()) != {"guard": "running", "deliver": "running"}:
                pass
            writer.transport.abort()
            while (await states())["guard"] == "running":
                pass
            assert (await states()) == {"guard": "cancelled", "deliver": "running"}
            problem(await lab.anna.get("/goals/x"), 404, "unknown_goal")
            assert len((await lab.anna.get("/goals")).json()["goals"]) == 2

    serve(test)


def test_a_client_that_does_not_read_is_disconnected(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(protocol, "WRITE_PATIENCE", 2.0)
    program = """
    { offer(goal, talk(text(string))) } { offer(event, said(text(string))) }
    +!talk(Text) <- for (.range(I, 1, 2000)) { .announce(said(Text)) }.
    """

    async def test(lab: Lab) -> None:
        address = httpx.URL(lab.door.url)
        head = f"GET /events HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer {token('anna')}\r\n\r\n"
        reader, writer = await asyncio.open_connection(address.host, address.port, limit=1024)
        writer.write(head.encode())
        await reader.readuntil(b": connected")
        async with lab.events() as events:
            await lab.anna.post("/agents/bob/goals/talk", json={"text": "x" * 9_000})
            count = 0
            async for each in events:
                count += each["event"] == "announced"
                if each.get("state") == "achieved":
                    break
            assert count == 2000
        while not writer.is_closing():  # it learns that it is disconnected when it writes
            writer.write(b"\r\n")
            assert (await lab.anna.get("/agents")).is_success
        writer.close()

    serve(test, program)


def test_a_reader_that_lags_gets_a_last_event() -> None:
    async def main() -> list[Any]:
        stream = Stream(asyncio.get_running_loop(), most=1)
        stream.put("{}")
        stream.put("{}")
        return [json.loads(each) async for some in messages(stream) for each in some]

    assert asyncio.run(main()) == [{"event": "lagging"}]


def test_an_event_is_encoded_once_for_all_streams(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(clients, "REMEMBERED", 80)
    encoder, facts, other = clients.Encoder(), [{"level": 80}], [{"level": 80}]
    goal = {"event": "goal", "id": "1"}
    first, second = ({"event": "belief", "agent": "bob", "beliefs": facts} for _ in range(2))

    assert encoder.text(first) is encoder.text(second)
    assert encoder.text(goal) is encoder.text(goal) == '{"event":"goal","id":"1"}'
    assert encoder.text({"event": "belief", "agent": "eve", "beliefs": other}) != encoder.text(second)
    assert len(encoder._known) == 2


def test_a_hundred_clients_watch() -> None:
    async def test(lab: Lab) -> None:
        ready, missing = asyncio.Event(), 100

        async def watch(name: str) -> list[Any]:
            async with lab.events(QUERY, name) as events:
                heard = [await anext(events)]
                nonlocal missing
                missing -= 1
                if not missing:
                    ready.set()
                while heard[-1].get("beliefs") != [{"level": 50}]:
                    heard.append(await anext(events))
                return heard

        watching = [asyncio.create_task(watch(name)) for name in ("anna", "wall") for _ in range(50)]
        await ready.wait()
        await deliver(lab)
        heard = await asyncio.gather(*watching)
        assert all(any(each["event"] == "announced" for each in found) for found in heard)

    serve(test)
