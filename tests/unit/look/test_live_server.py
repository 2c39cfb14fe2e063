"""The server of live pages, over real sockets: who may connect, and what hostile pages cannot do."""

import asyncio
import json
import threading
from collections.abc import Awaitable, Callable, Coroutine
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest
from live_client import PATIENCE, get, live_page, socket_address
from websockets.asyncio.client import ClientConnection, connect
from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect as sync_connect

import jacaros
from jacaros import Mas, UsageError
from jacaros.look import view
from jacaros.look.page.live import server
from jacaros.look.page.live import timing as allowance
from jacaros.look.page.live.access import Access, security_headers
from jacaros.look.records import records
from played import played

TOKEN = "a-token-that-tests-know"
COUNTS = "!count(0). +!count(N) <- -+counted(N); .wait(10); !count(N + 1)."


class Served:
    """An agent that counts, and the address of its page."""

    def __init__(self, mas: Mas, address: str) -> None:
        self.mas, self.address, self.socket = mas, address, socket_address(address)

    async def counts_on(self, steps: int = 5) -> None:
        """Wait until the agent has continued to count; fail if the run is blocked."""
        found = self.mas.agent("bob").ask("counted(N)")
        until = (found["N"] if found is not None else -1) + steps
        async with asyncio.timeout(PATIENCE):
            await self.mas.agent("bob").until(f"counted(N) & N >= {until}")

    async def opened(self) -> tuple[asyncio.StreamReader, asyncio.StreamWriter]:
        """Open a connection that says nothing."""
        host, port = self.address.split("/")[2].split(":")
        return await asyncio.open_connection(host, int(port))


def serving(test: Callable[[Served], Awaitable[None]]) -> None:
    async def main() -> None:
        async with Mas(seed=1, world="none", on_print=lambda *_: None) as mas:
            mas.add_agent("bob", COUNTS)
            async with view(mas, token=TOKEN) as address:
                await test(Served(mas, address))

    jacaros.run(main())


async def cut_off(talking: Coroutine[Any, Any, None]) -> None:
    """Wait until the server ends a connection."""
    with pytest.raises(ConnectionClosed):
        await asyncio.wait_for(talking, PATIENCE)


async def read_all(socket: ClientConnection) -> None:
    while True:
        await socket.recv()


async def again_and_again(socket: ClientConnection, message: str | bytes) -> None:
    while True:
        await socket.send(message)
        await asyncio.sleep(0.001)


async def is_refused(address: str, status: int, **options: Any) -> None:
    """Try to connect to a page."""
    with pytest.raises(InvalidStatus) as refused:
        await connect(socket_address(address), **options)
    assert refused.value.response.status_code == status


@played(serving)
async def test_the_page_and_its_modules_have_security_headers(lab) -> None:
    status, headers, content = await get(lab.address)
    assert status == 200
    assert content.lower().startswith(b"<!doctype html>")
    policy = headers["Content-Security-Policy"]
    assert "default-src 'none'" in policy
    assert "script-src 'self';" in policy
    assert "frame-ancestors 'none'" in policy
    assert headers["Cache-Control"] == "no-store"
    assert headers["X-Content-Type-Options"] == "nosniff"
    assert headers["Referrer-Policy"] == "no-referrer"
    status, headers, _content = await get(lab.address, "live.js")
    assert (status, headers["Content-Type"]) == (200, "text/javascript; charset=utf-8")


def test_a_page_can_be_framed_only_on_request() -> None:
    assert security_headers("127.0.0.1")["X-Frame-Options"] == "DENY"
    framed = security_headers("127.0.0.1", framed=True)
    assert "X-Frame-Options" not in framed
    assert "frame-ancestors *" in framed["Content-Security-Policy"]


@pytest.mark.parametrize(
    "path",
    ["../access.py", "..%2faccess.py", "/etc/passwd", "none.js", "live/", "page.html/", "\\..\\page.py"],
)
@played(serving)
async def test_other_files_are_not_served(lab, path: str) -> None:
    assert (await get(lab.address, path))[0] == 404


@pytest.mark.parametrize("token", ["", "x", TOKEN[:-1], f"{TOKEN}x", TOKEN.upper(), "%00", "%C3%BC"])
@played(serving)
async def test_a_wrong_token_is_refused(lab, token: str) -> None:
    wrong = lab.address.replace(TOKEN, token)
    assert (await get(wrong))[0] == 404
    await is_refused(wrong, 404)


FOREIGN = ["evil.example", "evil.example:80", "127.0.0.1.evil.example", "8.8.8.8", "", "a b"]
TUNNELS = ["localhost:8080", "127.0.0.1", "[::1]:1"]


@pytest.mark.parametrize(
    ("host", "status"), [*((each, 403) for each in FOREIGN), *((each, 200) for each in TUNNELS)]
)
@played(serving)
async def test_another_host_is_refused_and_a_tunnel_may_have_another_port(lab, host: str, status) -> None:
    assert (await get(lab.address, Host=host))[0] == status


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:1", "file://"])
@played(serving)
async def test_another_origin_is_refused(lab, origin: str) -> None:
    assert (await get(lab.address, Origin=origin))[0] == 403
    await is_refused(lab.address, 403, origin=origin)


@played(serving)
async def test_the_origin_of_the_page_is_accepted(lab) -> None:
    origin = lab.address.partition(f"/{TOKEN}")[0]
    async with connect(lab.socket, origin=origin) as socket:
        assert json.loads(await socket.recv())["kind"] == "hello"


@played(serving)
async def test_the_server_listens_on_the_loopback_alone(lab) -> None:
    assert lab.address.startswith("http://127.0.0.1:")
    assert not Access().exposed
    assert Access("0.0.0.0").exposed
    assert Access("192.168.1.5").exposed


def test_any_address_accepts_ip_addresses_but_no_foreign_names() -> None:
    access = Access("0.0.0.0", TOKEN)
    assert access.knows_host(["192.168.1.5:8000"])
    assert access.knows_host(["[fe80::1]:8000"])
    assert not access.knows_host(["evil.example:8000"])
    assert not access.knows_host(["192.168.1.5", "192.168.1.5"])


@pytest.mark.parametrize("token", ["short", "a token with many blanks", "a/token/with/slashes", ""])
def test_bad_tokens_are_refused(token: str) -> None:
    with pytest.raises(UsageError, match="invalid view token"):
        Access(token=token)


def test_random_tokens_differ() -> None:
    assert Access().token != Access().token
    assert len(Access().token) >= 32


@played(serving)
async def test_a_port_in_use_is_an_error(lab) -> None:
    port = int(lab.address.split(":")[2].split("/")[0])
    with pytest.raises(UsageError, match=r"cannot serve the view at 127.0.0.1:\d+: Address already in use\n"):
        async with view(lab.mas, port=port):
            pass


@played(serving)
async def test_a_late_page_receives_the_current_state(lab) -> None:
    await lab.counts_on()
    async with live_page(lab.address) as page:
        assert page.hello["live"] is True
        assert page.hello["version"] == 2
        await page.event("goal", agent="bob", state="pursued")
        assert page.records[0]["kind"] == "world"
        times = [each["t"] for each in page.records if "t" in each]
        assert times == sorted(times)


@played(serving)
async def test_closed_pages_are_harmless(lab) -> None:
    for _ in range(5):
        socket = await connect(lab.socket)
        await socket.send(json.dumps({"id": 1, "do": "console", "agent": "bob", "text": "?counted(X)"}))
        socket.transport.abort()
    await lab.counts_on()
    async with live_page(lab.address) as page:
        assert page.hello["can"]


@pytest.mark.parametrize("message", ["x", "[1]", "3", '"a"', "{" * 50_000, "[" * 50_000, b"\xff\xfe", "null"])
@played(serving)
async def test_garbage_gets_replies_and_then_a_disconnect(lab, message: str | bytes) -> None:
    async with live_page(lab.address) as page:
        await cut_off(again_and_again(page.socket, message))
    await lab.counts_on()


@played(serving)
async def test_a_huge_message_is_refused(lab) -> None:
    socket = await connect(lab.socket, max_size=None)

    async def say_and_read() -> None:
        await socket.send("x" * 10_000_000)
        await read_all(socket)

    await cut_off(say_and_read())
    await lab.counts_on()


@played(serving)
async def test_idle_connections_do_not_keep_out_a_page(lab, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server, "ADMITTED", 20)
    idle = [await lab.opened() for _ in range(400)]
    await lab.counts_on()
    for path in ("", "live.js", "page.css"):
        assert (await get(lab.address, path))[0] == 200
    async with live_page(lab.address) as page:
        assert page.hello["title"]
    for _, writer in idle:
        writer.transport.abort()


@played(serving)
async def test_requests_without_the_token_do_not_keep_out_a_page(lab, monkeypatch) -> None:
    monkeypatch.setattr(server, "ADMITTED", 20)
    stranger = lab.address.replace(TOKEN, "another-token-of-a-stranger")
    with monkeypatch.context() as patch:
        patch.setattr(server, "real_time", lambda: 0.0)  # all within one second
        answers = [(await get(stranger))[0] for _ in range(20)]
        assert answers == [404] * 20
        with pytest.raises((ConnectionError, IndexError)):  # reset, or closed without an answer
            await get(stranger)
        assert (await get(lab.address))[0] == 200
    await lab.counts_on()


@played(serving)
async def test_a_page_that_has_used_up_its_budget_waits_alone(lab, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(allowance, "SHARE", 1e-9)
    monkeypatch.setattr(allowance, "AHEAD", 0.0)
    async with live_page(lab.address) as flood, live_page(lab.address) as other:
        question = {"agent": "bob", "text": "?counted(N)"}
        await flood.done("console", **question)
        waiting = [asyncio.create_task(flood.do("console", **question)) for _ in range(50)]
        await other.done("console", **question)
        await lab.counts_on(20)
        assert not any(each.done() for each in waiting)
        for each in waiting:
            each.cancel()


@played(serving)
async def test_a_flood_of_connections_is_rejected(lab, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server, "ADMITTED", 20)

    async def turned_away() -> bool:
        reader, writer = await lab.opened()
        writer.write(b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
        try:
            return not await asyncio.wait_for(reader.read(), PATIENCE)
        except ConnectionError:
            return True
        finally:
            writer.transport.abort()

    away = await asyncio.gather(*(turned_away() for _ in range(60)))
    assert 20 <= away.count(True) < 60
    await lab.counts_on()
    async with asyncio.timeout(PATIENCE):
        while await turned_away():  # a second later there is room again
            await lab.counts_on(1)


@played(serving)
async def test_the_number_of_pages_is_limited(lab) -> None:
    sockets = [await connect(lab.socket) for _ in range(server.PAGES)]
    await is_refused(lab.address, 503)
    await lab.counts_on()
    for each in sockets:
        each.transport.abort()


@played(serving)
async def test_a_blocked_page_is_disconnected(lab, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server, "PATIENCE", 2.0)
    disconnected = asyncio.Event()
    disconnect = server.LiveServer._disconnect

    def noted(self: server.LiveServer, connection: ServerConnection) -> None:
        disconnected.set()
        disconnect(self, connection)

    monkeypatch.setattr(server.LiveServer, "_disconnect", noted)
    socket = await connect(lab.socket, max_queue=1, max_size=None)
    socket.transport.pause_reading()
    async with live_page(lab.address) as page:
        for index in range(3000):
            lab.mas.system.history().record(records.LogRecord("info", f"{index} {'x' * 4000}"))
            if index % 300 == 0:
                await asyncio.sleep(0)
        await page.until(lambda: any(f"2999 {'x' * 9}" in str(each) for each in page.records[-500:]))
        await asyncio.wait_for(disconnected.wait(), PATIENCE)
        await lab.counts_on()
    socket.transport.resume_reading()
    await cut_off(read_all(socket))


def test_a_page_changes_nothing_on_the_virtual_clock() -> None:
    """The page takes real time, and the agents have their turns at the same moments as without it."""
    program = "!go(0). +!go(200) <- .print(done). +!go(N) <- .wait(5); .print(N); !go(N + 1)."

    async def main(shown: bool) -> list[str]:
        printed: list[str] = []
        loop = asyncio.get_running_loop()

        def on_print(_: str, text: str) -> None:
            printed.append(f"{loop.time():.6f} {text}")

        async with Mas(seed=1, world="none", on_print=on_print) as mas:
            if not shown:
                mas.add_agent("bob", program)
                await mas.until_idle()
                return printed
            connected = threading.Event()
            async with view(mas) as address:
                with ThreadPoolExecutor() as threads:
                    reading = threads.submit(_read_until, '"199"', socket_address(address), connected)
                    await asyncio.to_thread(connected.wait, PATIENCE)
                    mas.add_agent("bob", program)
                    await mas.until_idle()
                    assert loop.time() == pytest.approx(1.0, abs=0.2)
                    assert '"kind":"hello"' in await asyncio.to_thread(reading.result)
        return printed

    shown = jacaros.run(main(True), clock="fast")
    assert shown == jacaros.run(main(False), clock="fast")
    assert len(shown) == 201


def _read_until(wanted: str, address: str, connected: threading.Event) -> str:
    text = ""
    with sync_connect(address, max_size=None) as socket:
        connected.set()
        while wanted not in text:
            text += str(socket.recv(timeout=PATIENCE))
    return text


@played(serving)
async def test_many_connections_do_not_end_a_page(lab, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server, "ADMITTED", 10_000)
    async with live_page(lab.address) as page:
        begun = []
        for _ in range(server.CONNECTIONS + 5):  # requests that never end
            _, writer = await lab.opened()
            writer.write(f"GET /{TOKEN}/ HTTP/1.1\r\n".encode())
            begun.append(writer)
        await lab.counts_on()
        await page.done("console", agent="bob", text="?counted(N)")
        for writer in begun:
            writer.transport.abort()
