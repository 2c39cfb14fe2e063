"""What an editor, or a user, may do wrong."""

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from dap_client import DapClient


@pytest.fixture
def client(tmp_path: Path) -> Iterator[DapClient]:
    with DapClient(tmp_path) as client:
        yield client


LOOP = "!go.\n+!go\n   <- .wait(50);\n      !go.\n"


@pytest.fixture
def loop(tmp_path: Path) -> Path:
    path = tmp_path / "loop.asl"
    path.write_text(LOOP)
    return path


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({}, "`program` is missing; name a .asl, .py, .mas2j or .jcm file"),
        ({"program": "gone.asl"}, "file not found: `gone.asl`"),
        ({"program": "bad.asl"}, "bad.asl:1:11: missing body after `<-`"),
        ({"program": "bad.asl", "args": "--seed"}, "`args` must be a list of strings, found '--seed'"),
        ({"program": "bad.asl", "seed": True}, "`seed` must be a string or a number, found True"),
        ({"program": "bad.asl", "seed": "x"}, "--seed: 'x' is not a valid integer"),
        ({"program": "bad.asl", "args": ["--sed", "1"]}, "unknown option: `--sed`"),
        ({"program": "bad.asl", "cwd": "nowhere"}, "cannot change to `nowhere`: No such file or directory"),
    ],
)
def test_a_launch_that_fails_says_why(
    client: DapClient, tmp_path: Path, arguments: dict[str, object], message: str
) -> None:
    (tmp_path / "bad.asl").write_text("!go. +!go <- \n")
    client.ask("initialize", adapterID="x")
    response = client.response("launch", **arguments)
    assert not response["success"]
    assert response["message"] == message
    assert response["body"]["error"]["showUser"]
    assert client.process.wait(60) in (1, 2)


def test_the_client_that_closes_the_pipe_ends_the_run(client: DapClient, loop: Path) -> None:
    client.launch(loop, [{"line": 3}])
    client.event("stopped")
    assert client.end() == 0


def test_the_client_that_leaves_before_the_launch_ends_the_process(client: DapClient) -> None:
    client.ask("initialize", adapterID="x")
    client.ask("disconnect")
    assert client.process.wait(60) == 0


@pytest.mark.parametrize(
    "data", [b"GET / HTTP/1.0\r\n\r\n", b"Content-Length: x\r\n\r\n", b"Content-Length: 2\r\n\r\n[]"]
)
def test_what_is_not_the_protocol_ends_the_process_with_a_message(client: DapClient, data: bytes) -> None:
    client.send_bytes(data)
    assert client.end() == 1
    assert client.errors().startswith("error: ")


def test_garbage_in_the_middle_of_a_run_ends_it(client: DapClient, loop: Path) -> None:
    client.launch(loop, [{"line": 3}])
    client.event("stopped")
    client.send_bytes(b"Content-Length: 3\r\n\r\n{{{")
    client.event("terminated")
    assert client.process.wait(60) == 0


def test_requests_with_wrong_arguments_are_refused_and_the_session_continues(
    client: DapClient, loop: Path
) -> None:
    client.launch(loop, [{"line": 3}])
    stopped = client.event("stopped")
    for command, arguments, told in (
        ("stackTrace", {"threadId": 99}, "unknown thread: 99"),
        ("stackTrace", {}, "invalid arguments of stackTrace: KeyError: 'threadId'"),
        ("scopes", {"frameId": 7_000}, "unknown stack frame: 7000"),
        ("next", {"threadId": "one"}, "invalid arguments of next: TypeError: `threadId` is not a number"),
        ("setBreakpoints", {"source": {}}, "invalid arguments of setBreakpoints: KeyError: 'path'"),
        ("evaluate", {"expression": "?p(", "frameId": "x"}, "invalid arguments of evaluate: ValueError"),
        ("exceptionInfo", {"threadId": 1}, "the run is not paused at a failure"),
        ("goto", {}, "unknown request: goto"),
    ):
        response = client.response(command, **arguments)
        assert not response["success"]
        assert response["message"].startswith(told), json.dumps(response)
    assert client.ask("variables", variablesReference=10_000) == {"variables": []}
    assert client.lines(stopped) == [3]


def test_a_file_that_no_agent_runs_yet_is_checked_when_one_does(client: DapClient, tmp_path: Path) -> None:
    later = tmp_path / "later.asl"
    later.write_text("!do.\n+!do\n   <- .print(x).\n")
    first = tmp_path / "first.asl"
    first.write_text('!go.\n+!go\n   <- .print(a);\n      .create_agent(bob, "later.asl").\n')
    client.launch(first, [{"line": 3}])
    stopped = client.event("stopped")
    set_ = client.ask("setBreakpoints", source={"path": str(later)}, breakpoints=[{"line": 1}])
    assert set_["breakpoints"][0]["message"] == "no agent runs this file yet"
    client.resume(stopped)
    changed = client.event("breakpoint")["breakpoint"]
    assert (changed["verified"], changed["line"]) == (True, 2)
    stopped = client.event("stopped")
    assert client.frames(stopped)[0]["source"]["name"] == "later.asl"
