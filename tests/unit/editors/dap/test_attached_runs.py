"""An editor attaches to a run that serves callers, and leaves it as it was."""

import asyncio
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from dap_client import DapClient

import jacaros
from jacaros import Mas
from jacaros.editors.dap.door import DebugDoor
from jacaros.editors.dap.relay import PATH
from jacaros.runtime.mas.debugging import DebugState
from jacaros.serving.http.door import Address, HttpDoor
from jacaros.serving.tokens import Tokens

Arguments = Mapping[str, Any]
Look = Callable[[DapClient, Arguments], None]
LOOP = "n(0).\n!go.\n+!go : n(N)\n   <- .print(at, N);\n      -+n(N + 1);\n      .wait(20);\n      !go.\n"


async def is_left(mas: Mas) -> None:
    """Wait until a run continues without breakpoints."""
    left: asyncio.Future[None] = asyncio.get_running_loop().create_future()

    def notice(state: DebugState) -> None:
        if state.state == "running" and not state.breakpoints and not left.done():
            left.set_result(None)

    end = mas.debugger.listen(notice)
    notice(mas.debugger.state)
    await asyncio.wait_for(left, 60)
    end()


def attached(
    folder: Path, look: Look, given: Callable[[HttpDoor, Tokens], Arguments] = lambda *_: {}
) -> None:
    """Run `LOOP`, and call *look* with an editor and what it gives to attach."""
    program = folder / "loop.asl"
    program.write_text(LOOP)

    async def main() -> None:
        async with Mas(program, on_print=lambda *line: None, on_log=lambda *line: None) as mas:
            tokens = Tokens({})
            door = HttpDoor(mas.system, Address(), tokens, {PATH: partial(DebugDoor, mas.system)})
            with DapClient(folder) as client:
                await asyncio.to_thread(client.ask, "initialize", adapterID="x")
                await asyncio.to_thread(look, client, given(door, tokens))
                if mas.exit_code is None:
                    await is_left(mas)
            await door.close()

    jacaros.run(main())


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    return tmp_path


def test_an_editor_attaches_to_the_only_run_and_leaves_it(folder: Path) -> None:
    def look(client: DapClient, arguments: Arguments) -> None:
        client.ask("attach", **arguments)
        client.event("initialized")
        lines = [{"line": 6, "condition": "N > 5"}]
        client.ask("setBreakpoints", source={"path": str(folder / "loop.asl")}, breakpoints=lines)
        client.ask("configurationDone")
        stopped = client.event("stopped")
        assert client.lines(stopped) == [6]
        assert int(client.scope(stopped, "Bindings")["N"]["value"]) > 5
        client.ask("disconnect")
        assert client.end() == 0
        assert "[loop] at" in client.output["stdout"]

    attached(folder, look)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"token": "wrong"}, "unknown token"),
        ({"url": "http://127.0.0.1:1", "token": "x"}, "no answer from http://127.0.0.1:1: "),
        ({"url": "nowhere:x", "token": "x"}, "invalid URL: `nowhere:x`"),
    ],
)
def test_an_editor_that_cannot_attach_says_why(folder: Path, wrong: dict[str, str], message: str) -> None:
    def look(client: DapClient, arguments: Arguments) -> None:
        response = client.response("attach", **arguments)
        assert not response["success"]
        assert response["message"].startswith(message)
        assert client.process.wait(60) in (1, 2)

    attached(folder, look, lambda door, _: {"url": door.url, **wrong})


def test_only_operators_may_debug(folder: Path) -> None:
    def look(client: DapClient, arguments: Arguments) -> None:
        response = client.response("attach", **arguments)
        assert (response["success"], response["message"]) == (False, "only operators may debug")

    attached(folder, look, lambda door, tokens: {"url": door.url, "token": tokens.new("anna", "user")})


def test_the_end_of_the_run_ends_the_session(folder: Path) -> None:
    def look(client: DapClient, arguments: Arguments) -> None:
        client.ask("attach", **arguments, stopOnEntry=True)
        client.event("initialized")
        client.ask("configurationDone")
        assert client.event("stopped")["reason"] == "entry"
        client.ask("terminate")
        assert client.event("exited") == {"exitCode": 0}

    attached(folder, look)
