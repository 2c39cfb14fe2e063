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
from jacaros.look.page.live.access import Access
from jacaros.look.records import records

TOKEN = "a-token-that-tests-know"
COUNTS = "!count(0). +!count(N) <- -+counted(N); .wait(10); !count(N + 1)."


def serving(test: Callable[[Mas, str], Awaitable[None]], program: str = COUNTS) -> None:
    """Run a test with an agent that counts, and the address of its page."""

    async def main() -> None:
        async with Mas(seed=1, world="none", on_print=lambda *_: None) as mas:
            mas.add_agent("bob", program)
            async with view(mas, token=TOKEN) as address:
                await test(mas, address)

    jacaros.run(main())


def counted(mas: Mas) -> int:
    """Return the agent's count."""
    found = mas.agent("bob").ask("counted(N)")
    return found["N"] if found is not None else -1


async def counts_on(mas: Mas, steps: int = 5) -> None:
    """Wait until the agent has continued to count; fail if the run is blocked."""
    until = counted(mas) + steps
    async with asyncio.timeout(PATIENCE):
        await mas.agent("bob").until(f"counted(N) & N >= {until}")


async def _cut_off(talking: Coroutine[Any, Any, None]) -> None:
    """Wait until the server ends a connection."""
    with pytest.raises(ConnectionClosed):
        await asyncio.wait_for(talking, PATIENCE)


async def _read_all(socket: ClientConnection) -> None:
    while True:
        await socket.recv()


async def _say_and_read(socket: ClientConnection, message: str) -> None:
    await socket.send(message)
    await _read_all(socket)


async def _again_and_again(socket: ClientConnection, message: str | bytes) -> None:
    while True:
        await socket.send(message)
        await asyncio.sleep(0.001)


def test_the_page_and_its_modules_have_security_headers() -> None:
    async def test(_: Mas, address: str) -> None:
        status, headers, content = await get(address)
        assert status == 200
        assert content.lower().startswith(b"<!doctype html>")
        policy = headers["Content-Security-Policy"]
        assert "default-src 'none'" in policy
        assert "script-src 'self';" in policy
        assert "frame-ancestors 'none'" in policy
        assert headers["Cache-Control"] == "no-store"
        assert headers["X-Content-Type-Options"] == "nosniff"
        assert headers["Referrer-Policy"] == "no-referrer"
        status, headers, _content = await get(address, "live.js")
        assert (status, headers["Content-Type"]) == (200, "text/javascript; charset=utf-8")

    serving(test)


@pytest.mark.parametrize(
    "path",
    ["../access.py", "..%2faccess.py", "/etc/passwd", "none.js", "live/", "page.html/", "\\..\\page.py"],
)
def test_other_files_are_not_served(path: str) -> None:
    async def test(_: Mas, address: str) -> None:
        assert (await get(address, path))[0] == 404

    serving(test)


@pytest.mark.parametrize("token", ["", "x", TOKEN[:-1], f"{TOKEN}x", TOKEN.upper(), "%00", "%C3%BC"])
def test_a_wrong_token_is_refused(token: str) -> None:
    async def test(_: Mas, address: str) -> None:
        wrong = address.replace(TOKEN, token)
        assert (await get(wrong))[0] == 404
        with pytest.raises(InvalidStatus) as refused:
            await connect(socket_address(wrong))
        assert refused.value.response.status_code == 404

    serving(test)


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:80", "127.0.0.1.evil.example", "8.8.8.8", "", "a b"]
)
def test_another_host_is_refused(host: str) -> None:
    async def test(_: Mas, address: str) -> None:
        assert (await get(address, Host=host))[0] == 403

    serving(test)


@pytest.mark.parametrize("host", ["localhost:8080", "127.0.0.1", "[::1]:1"])
def test_a_tunnel_may_have_another_port(host: str) -> None:
    async def test(_: Mas, address: str) -> None:
        assert (await get(address, Host=host))[0] == 200

    serving(test)


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:1", "file://"])
def test_another_origin_is_refused(origin: str) -> None:
    async def test(_: Mas, address: str) -> None:
        assert (await get(address, Origin=origin))[0] == 403
        with pytest.raises(InvalidStatus) as refused:
            await connect(socket_address(address), origin=origin)  # type: ignore[arg-type]
        assert refused.value.response.status_code == 403

    serving(test)


def test_the_origin_of_the_page_is_accepted() -> None:
    async def test(_: Mas, address: str) -> None:
        origin = address.partition(f"/{TOKEN}")[0]
        async with connect(socket_address(address), origin=origin) as socket:  # type: ignore[arg-type]
            assert json.loads(await socket.recv())["kind"] == "hello"

    serving(test)


def test_the_server_listens_on_the_loopback_alone() -> None:
    async def test(_: Mas, address: str) -> None:
        assert address.startswith("http://127.0.0.1:")

    serving(test)
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


def test_a_port_in_use_is_an_error() -> None:
    async def test(mas: Mas, address: str) -> None:
        port = int(address.split(":")[2].split("/")[0])
        with pytest.raises(
            UsageError, match=r"cannot serve the view at 127.0.0.1:\d+: Address already in use"
        ):
            async with view(mas, port=port):
                pass

    serving(test)


def test_a_late_page_receives_the_current_state() -> None:
    async def test(mas: Mas, address: str) -> None:
        await counts_on(mas)
        async with live_page(address) as page:
            assert page.hello["live"] is True
            assert page.hello["version"] == 2
            await page.event("goal", agent="bob", state="pursued")
            assert page.records[0]["kind"] == "world"
            times = [each["t"] for each in page.records if "t" in each]
            assert times == sorted(times)

    serving(test)


def test_closed_pages_are_harmless() -> None:
    async def test(mas: Mas, address: str) -> None:
        for _ in range(5):
            socket = await connect(socket_address(address))
            await socket.send(json.dumps({"id": 1, "do": "console", "agent": "bob", "text": "?counted(X)"}))
            socket.transport.abort()
        await counts_on(mas)
        async with live_page(address) as page:
            assert page.hello["can"]

    serving(test)


@pytest.mark.parametrize("message", ["x", "[1]", "3", '"a"', "{" * 50_000, "[" * 50_000, b"\xff\xfe", "null"])
def test_garbage_gets_replies_and_then_a_disconnect(message: str | bytes) -> None:
    async def test(mas: Mas, address: str) -> None:
        async with live_page(address) as page:
            await _cut_off(_again_and_again(page.socket, message))
        await counts_on(mas)

    serving(test)


def test_a_huge_message_is_refused() -> None:
    async def test(mas: Mas, address: str) -> None:
        socket = await connect(socket_address(address), max_size=None)
        await _cut_off(_say_and_read(socket, "x" * 10_000_000))
        await counts_on(mas)

    serving(test)


def test_idle_connections_do_not_keep_out_a_page(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server, "ADMITTED", 20)

    async def test(mas: Mas, address: str) -> None:
        host, port = address.split("/")[2].split(":")
        idle = [await asyncio.open_connection(host, int(port)) for _ in range(400)]
        await counts_on(mas)
        for path in ("", "live.js", "page.css"):
            status, _, _ = await get(address, path)
            assert status == 200
        async with live_page(address) as page:
            assert page.hello["title"]
        for _, writer in idle:
            writer.transport.abort()

    serving(test)


def test_requests_without_the_token_do_not_keep_out_a_page(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server, "ADMITTED", 20)

    async def test(mas: Mas, address: str) -> None:
        stranger = address.replace(TOKEN, "another-token-of-a-stranger")
        with monkeypatch.context() as patch:
            patch.setattr(server, "real_time", lambda: 0.0)  # all within one second
            answers = [(await get(stranger))[0] for _ in range(20)]
            assert answers == [404] * 20
            with pytest.raises((ConnectionError, IndexError)):  # reset, or closed without an answer
                await get(stranger)
            assert (await get(address))[0] == 200
        await counts_on(mas)

    serving(test)


def test_a_page_that_has_used_up_its_budget_waits_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(allowance, "SHARE", 1e-9)
    monkeypatch.setattr(allowance, "AHEAD", 0.0)

    async def test(mas: Mas, address: str) -> None:
        async with live_page(address) as flood, live_page(address) as other:
            question = {"agent": "bob", "text": "?counted(N)"}
            assert (await flood.do("console", **question))["ok"]
            waiting = [asyncio.create_task(flood.do("console", **question)) for _ in range(50)]
            assert (await other.do("console", **question))["ok"]
            await counts_on(mas, 20)
            assert not any(each.done() for each in waiting)
            for each in waiting:
                each.cancel()

    serving(test)


def test_a_flood_of_connections_is_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server, "ADMITTED", 20)

    async def test(mas: Mas, address: str) -> None:
        host, port = address.split("/")[2].split(":")

        async def turned_away() -> bool:
            reader, writer = await asyncio.open_connection(host, int(port))
            writer.write(b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
            try:
                return not await asyncio.wait_for(reader.read(), PATIENCE)
            except ConnectionError:
                return True
            finally:
                writer.transport.abort()

        away = await asyncio.gather(*(turned_away() for _ in range(60)))
        assert 20 <= away.count(True) < 60
        await counts_on(mas)
        async with asyncio.timeout(PATIENCE):
            while await turned_away():  # a second later there is room again
                await counts_on(mas, 1)

    serving(test)


def test_the_number_of_pages_is_limited() -> None:
    async def test(mas: Mas, address: str) -> None:
        sockets = [await connect(socket_address(address)) for _ in range(server.PAGES)]
        with pytest.raises(InvalidStatus) as refused:
            await connect(socket_address(address))
        assert refused.value.response.status_code == 503
        await counts_on(mas)
        for each in sockets:
            each.transport.abort()

    serving(test)


def test_a_blocked_page_is_disconnected(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server, "PATIENCE", 2.0)
    cut_off = asyncio.Event()
    disconnect = server.LiveServer._disconnect

    def disconnected(self: server.LiveServer, connection: ServerConnection) -> None:
        cut_off.set()
        disconnect(self, connection)

    monkeypatch.setattr(server.LiveServer, "_disconnect", disconnected)

    async def test(mas: Mas, address: str) -> None:
        socket = await connect(socket_address(address), max_queue=1, max_size=None)
        socket.transport.pause_reading()
        async with live_page(address) as page:
            for index in range(3000):
                mas.system.history().record(records.LogRecord("info", f"{index} {'x' * 4000}"))
                if index % 300 == 0:
                    await asyncio.sleep(0)
            await page.until(lambda: any(f"2999 {'x' * 9}" in str(each) for each in page.records[-500:]))
            await asyncio.wait_for(cut_off.wait(), PATIENCE)
            await counts_on(mas)
        socket.transport.resume_reading()
        await _cut_off(_read_all(socket))

    serving(test)


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
            async with view(mas) as address:
                connected = threading.Event()
                with ThreadPoolExecutor() as threads:
                    reading = threads.submit(_read_until, '"199"', socket_address(address), connected)
                    await asyncio.to_thread(connected.wait, PATIENCE)
                    mas.add_agent("bob", program)
                    await mas.until_idle()
                    assert loop.time() == pytest.approx(1.0, abs=0.2)
                    text = await asyncio.to_thread(reading.result)
                assert '"kind":"hello"' in text
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


def test_many_connections_do_not_end_a_page(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server, "ADMITTED", 10_000)

    async def test(mas: Mas, address: str) -> None:
        host, port = address.split("/")[2].split(":")
        async with live_page(address) as page:
            begun = []
            for _ in range(server.CONNECTIONS + 5):  # requests that never end
                _, writer = await asyncio.open_connection(host, int(port))
                writer.write(f"GET /{TOKEN}/ HTTP/1.1\r\n".encode())
                begun.append(writer)
            await counts_on(mas)
            reply = await page.do("console", agent="bob", text="?counted(N)")
            assert reply["ok"]
            for writer in begun:
                writer.transport.abort()

    serving(test)
