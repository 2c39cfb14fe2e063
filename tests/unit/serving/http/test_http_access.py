"""Who may call over HTTP: tokens, hosts, origins, limits of connections, and hostile requests."""

import asyncio
import random
import shutil
import ssl
import subprocess
from pathlib import Path

import httpx
import pytest
from http_lab import Lab, problem, serve, token

from jacaros.runtime.errors import UsageError
from jacaros.serving.http import guard, protocol
from jacaros.serving.http.door import Address
from jacaros.serving.service import Session

BATTERY = "/agents/bob/beliefs/battery"
CURL = shutil.which("curl")
GET = f"GET {BATTERY} HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer {token('anna')}\r\n"


@pytest.mark.parametrize(
    ("headers", "status", "code"),
    [
        ({}, 401, "unauthorized"),
        ({"Authorization": "Bearer wrong"}, 401, "unauthorized"),
        ({"Authorization": f"Basic {token('anna')}"}, 401, "unauthorized"),
        ({"Authorization": f"Bearer {token('anna')}x"}, 401, "unauthorized"),
        ({"Authorization": f"Bearer {token('anna')}", "Host": "evil.example"}, 403, "foreign_host"),
        (
            {"Authorization": f"Bearer {token('anna')}", "Origin": "http://evil.example"},
            403,
            "foreign_origin",
        ),
        ({"Authorization": f"Bearer {token('anna')}", "Origin": "null"}, 403, "foreign_origin"),
    ],
)
def test_strangers_are_refused(headers: dict[str, str], status: int, code: str) -> None:
    async def test(lab: Lab) -> None:
        async with lab.client(**headers) as stranger:
            for method, path in (("GET", BATTERY), ("POST", "/agents/bob/goals/guard"), ("OPTIONS", BATTERY)):
                response = await stranger.request(method, path)
                problem(response, status, code)
                assert not [each for each in response.headers if each.startswith("access-control")]
            problem(await stranger.get(f"{BATTERY}?access_token={token('anna')}"), status, code)
        assert (await lab.anna.get("/goals")).json() == {"goals": []}

    serve(test)


def test_the_random_token_of_the_door_is_an_operators_and_ends_with_the_run() -> None:
    tokens = []

    async def test(lab: Lab) -> None:
        for each in tokens:
            async with lab.client(Authorization=f"Bearer {each}") as old:
                problem(await old.get("/artifacts"), 401, "unauthorized")
        tokens.append(lab.door.token)
        async with lab.client(Authorization=f"bearer {lab.door.token}") as client:
            assert (await client.get("/artifacts")).status_code == 200

    serve(test)
    serve(test)


@pytest.mark.skipif(CURL is None, reason="curl is not installed")
def test_curl_gives_a_goal() -> None:
    async def test(lab: Lab) -> None:
        url = f"{lab.door.url}/agents/bob/goals/count"
        headers = ("-H", f"Authorization: Bearer {token('anna')}", "-H", "Prefer: wait=30")
        command = (str(CURL), "-sf", *headers, url, "-d", '{"n": 3}')
        done = await asyncio.to_thread(subprocess.run, command, capture_output=True, text=True, timeout=60)
        assert (done.returncode, '"results":{"next":4}' in done.stdout) == (0, True)

    serve(test)


async def answered(lab: Lab, sent: bytes, more: bytes = b"") -> bytes:
    """Send bytes over a connection of their own. Return what comes until it is closed."""
    address = httpx.URL(lab.door.url)
    reader, writer = await asyncio.open_connection(address.host, address.port)
    try:
        writer.write(sent)
        found = b""
        while piece := await reader.read(1 << 16):
            found += piece
            writer.write(more)
        return found
    except ConnectionError:
        return found
    finally:
        writer.close()


@pytest.mark.parametrize("sent", [b"", b"GET / HTTP/1.1\r\nX: ", GET.encode()])
def test_a_header_that_never_ends_is_not_awaited(sent: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(protocol, "HEADER_PATIENCE", 0.2)

    async def test(lab: Lab) -> None:
        assert await answered(lab, sent) == b""

    serve(test)


@pytest.mark.parametrize("before", ["", f"{GET}\r\n"])
def test_a_header_that_is_too_large_is_refused(before: str) -> None:
    async def test(lab: Lab) -> None:
        sent = f"{before}GET / HTTP/1.1\r\nX: {'x' * protocol.LARGEST_HEADER}"
        assert b"400 Bad Request" in await answered(lab, sent.encode())

    serve(test)


def test_a_second_header_that_trickles_is_not_awaited(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(protocol, "HEADER_PATIENCE", 0.2)

    async def test(lab: Lab) -> None:
        address = httpx.URL(lab.door.url)
        reader, writer = await asyncio.open_connection(address.host, address.port)
        writer.write(f"{GET}\r\n".encode())
        await reader.readuntil(b"}]}")
        writer.write(b"GET ")
        while not reader.at_eof():
            writer.write(b"x")
            try:
                await asyncio.wait_for(reader.read(1), 0.02)
            except TimeoutError:
                continue
            except ConnectionError:
                break
        writer.close()

    serve(test)


def test_a_body_that_never_ends_is_not_awaited(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(guard, "BODY_PATIENCE", 0.2)

    async def test(lab: Lab) -> None:
        head = GET.replace("GET", "POST").replace("beliefs/battery", "goals/guard")
        found = await answered(lab, f"{head}Connection: close\r\nContent-Length: 10\r\n\r\n{{".encode())
        assert b"400 Bad Request" in found
        assert b"did not arrive within 0.2 s" in found
        assert (await lab.anna.get("/goals")).json() == {"goals": []}

    serve(test)


def test_idle_connections_do_not_keep_out_others(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(protocol, "MOST_CONNECTIONS", 5)

    async def test(lab: Lab) -> None:
        address = httpx.URL(lab.door.url)
        idle = [await asyncio.open_connection(address.host, address.port) for _ in range(20)]
        assert (await lab.anna.get(BATTERY)).status_code == 200
        with pytest.raises((ConnectionError, asyncio.IncompleteReadError)):
            await idle[0][0].readexactly(1)
        for _, writer in idle:
            writer.close()

    serve(test)


@pytest.mark.parametrize("sent", [b"\x16\x03\x01\x02\x00\x01\x00", b"hello\r\n\r\n", b"GET / HTTP/9\r\n\r\n"])
def test_what_is_not_http_gets_a_problem_document(sent: bytes) -> None:
    async def test(lab: Lab) -> None:
        found = await answered(lab, sent + b"\r\n\r\n")
        assert found.startswith(b"HTTP/1.1 400 Bad Request\r\n")
        assert b'"code": "malformed"' in found

    serve(test)


def certificate(folder: Path) -> Address:
    files = folder / "cert.pem", folder / "key.pem"
    subject = ("-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost,IP:127.0.0.1")
    command = (
        "openssl",
        "req",
        "-x509",
        "-newkey",
        "ec",
        "-pkeyopt",
        "ec_paramgen_curve:prime256v1",
        "-nodes",
    )
    subprocess.run(
        [*command, *subject, "-out", files[0], "-keyout", files[1]], check=True, capture_output=True
    )
    return Address(certificate=files[0], key=files[1])


@pytest.mark.skipif(shutil.which("openssl") is None, reason="openssl is not installed")
def test_https(tmp_path: Path) -> None:
    address = certificate(tmp_path)

    async def test(lab: Lab) -> None:
        trusted = ssl.create_default_context(cafile=str(address.certificate))
        headers = {"Authorization": f"Bearer {token('anna')}"}
        async with httpx.AsyncClient(base_url=lab.door.url, verify=trusted, headers=headers) as client:
            assert client.base_url.scheme == "https"
            assert (await client.get(BATTERY)).json() == {"beliefs": [{"level": 80}]}

    serve(test, address=address)


def test_a_certificate_that_cannot_be_read_is_an_error_before_the_run_serves(tmp_path: Path) -> None:
    async def test(_: Lab) -> None:
        raise AssertionError("served")

    wrong = tmp_path / "cert.pem"
    wrong.write_text("no certificate")
    with pytest.raises(UsageError, match=r"cannot use the certificate .*cert\.pem"):
        serve(test, address=Address(certificate=wrong, key=wrong))


def test_a_caller_cannot_write_lines_of_the_log() -> None:
    async def test(lab: Lab) -> None:
        await lab.anna.post("/agents/bob/beliefs/closed", json={"room": "office"})
        parcel = "x\n[bob] error: forged\x1b[2J" + "y" * 5_000
        given = await lab.anna.post("/agents/bob/goals/deliver", json={"parcel": parcel, "room": "office"})
        problem(given, 409, "refused")

    (line,) = [line for line in serve(test) if "refused" in line]
    assert "\n" not in line
    assert "\x1b" not in line
    assert len(line) < 600


def test_a_defect_is_logged_without_a_flood(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(_: Session) -> None:
        raise KeyError("oh")

    monkeypatch.setattr(Session, "goals", broken)

    async def test(lab: Lab) -> None:
        for _ in range(30):
            problem(await lab.anna.get("/goals"), 500, "internal_error")

    log = [line for line in serve(test) if "internal error" in line]
    assert len(log) == 2
    assert log[0].startswith("internal error: HTTP server: KeyError: 'oh'; please file an issue\nTraceback")
    assert log[1] == "internal error: HTTP server: KeyError: 'oh' (10 times); please file an issue"


def test_a_run_that_starts_again_serves_at_the_same_port() -> None:
    ports = [0]

    async def test(lab: Lab) -> None:
        ports.append(httpx.URL(lab.door.url).port or 0)
        assert (await lab.anna.get(BATTERY)).status_code == 200

    serve(test)
    serve(test, address=Address(port=ports[1]))
    assert ports[1] == ports[2]


PATHS = (
    *(
        "/",
        "/agents",
        "/agents/bob",
        "/agents/eve",
        "/goals",
        "/goals/x",
        "/why",
        "/questions",
        "/questions/x-1",
    ),
    *(
        f"/agents/bob/goals/{each}"
        for each in ("deliver", "count", "reset", "secret", "count/x", ".stopMAS", "%00")
    ),
    *(f"/agents/bob/beliefs/{each}" for each in ("battery", "secret", "closed", "a" * 300)),
    *(
        "/agents/bob/questions/double",
        "/agents/bob/questions/",
        "/openapi.json",
        "/artifacts",
        "/..",
        "//",
        "/%ff",
    ),
)
VALUES = (
    *(
        "null",
        "true",
        "-1",
        "1e999",
        "3.5",
        '"x"',
        '"\\ud800"',
        '""',
        "[]",
        "{}",
        "[" * 500 + "]" * 500,
        "NaN",
    ),
    *(
        '{"atom": "x"}',
        '{"functor": "f", "arguments": []}',
        '"' + "y" * 20_000 + '"',
        "1" * 5_000,
        '"\\u0000"',
    ),
)


def fuzzed(random: random.Random) -> tuple[str, str, dict[str, str], bytes]:
    """Return method, path, headers and body of a request that must have no effect."""
    method = random.choice(("GET", "POST", "DELETE", "PUT", "PATCH", "OPTIONS", "HEAD", "BREW"))
    query = random.choice(
        ("", "", "?question=" + random.choice(("", "why +x", "(", "%ff" * 50)), "?limit=-1&at=x")
    )
    name = random.choice(("anna", "wall", "nobody", "", "boss\t"))
    headers = {"Authorization": f"Bearer {token(name)}"} if name else {}
    if random.random() < 0.1:
        headers["Prefer"] = random.choice(("wait=x", "wait=-1", "wait", "=;,"))
    if random.random() < 0.05:
        headers["Origin"] = random.choice(
            ("null", "http://evil.example", "://", "http:" + "//[", "http://127.0.0.1:1")
        )
    names = random.choices(
        ("parcel", "room", "n", "x", "", "text", "option", "__class__"), k=random.randrange(4)
    )
    body = "{" + ", ".join(f'"{each}": {random.choice(VALUES)}' for each in names) + "}"
    if random.random() < 0.2:
        body = body[: random.randrange(len(body) + 1)]
    raw = body.encode() if random.random() < 0.9 else random.randbytes(random.randrange(2_000))
    return method, random.choice(PATHS) + query, headers, raw


@pytest.mark.parametrize("count", [500, pytest.param(10_000, marks=pytest.mark.slow)])
def test_fuzzed_requests_are_answered_clearly_and_change_nothing(count: int) -> None:
    async def test(lab: Lab) -> None:
        mind = lab.mas.agent("bob")
        before = set(map(str, mind.beliefs))
        chance = random.Random(38)
        async with lab.client() as client:
            for _ in range(count):
                method, path, headers, body = fuzzed(chance)
                allowed = {
                    name: value for name, value in headers.items() if value.isprintable() or "\t" in value
                }
                response = await client.request(method, path, headers=allowed, content=body)
                told = f"{method} {path} {body[:200]!r}: {response.text[:300]}"
                if response.status_code == 307:  # a slash at the end
                    assert response.headers["location"].startswith(lab.door.url), told
                elif response.status_code >= 300:
                    assert response.status_code < 500, told
                    if method != "HEAD":
                        problem(response, response.status_code, response.json()["code"])
                elif method not in ("GET", "HEAD"):
                    # What fits by chance: a question, and a goal of this program that has no side effects.
                    assert path.partition("?")[0].endswith(("/double", "/count", "/closed")), told
        after = {each for each in map(str, mind.beliefs) if not each.startswith("closed(")}
        assert after == before
        assert (await lab.anna.get(BATTERY)).json() == {"beliefs": [{"level": 80}]}

    assert [line for line in serve(test) if "error" in line] == []
