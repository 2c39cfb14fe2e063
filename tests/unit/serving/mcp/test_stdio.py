"""A language model's client and a robot over the standard input and output, on the embedded world."""

import asyncio
import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from mcp.client import Client
from mcp.client.subscriptions import ResourceUpdated
from mcp.shared.exceptions import MCPError
from mcp_lab import ERAS, ROBOT, WORLD, client, text, told, wait_for, with_client

from jacaros.runtime.cli.main import call

LAMP = """
{ offer(goal, shine(seconds(number))) }
{ offer(goal, glow, when_left(cancel)) }
{ offer(goal, sum(a(number), b(number), sum(out(number)))) }
{ offer(belief, lit(yes(boolean))) }
{ offer(tell, lit(yes(boolean))) }
lit(false).
+!shine(Seconds) <- .wait(Seconds * 1000); .print("shone for ", Seconds).
@glow[cleanup(dim)] +!glow <- .wait(3600000).
+!dim <- .print(dimmed).
+!sum(A, B, A + B).
"""


@pytest.mark.parametrize("mode", ERAS)
def test_a_client_sends_a_robot_somewhere_cancels_and_asks_why_it_stopped(mode: str, tmp_path: Path) -> None:
    notes: list[str | None] = []

    async def test(model: Client) -> None:
        tools = {each.name: each for each in (await model.list_tools()).tools}
        go = tools["robot_go"]
        assert go.input_schema["properties"]["place"]["enum"] == ["window", "corner", "dock"]
        assert go.annotations is not None
        assert (go.annotations.idempotent_hint, go.annotations.read_only_hint) == (True, False)
        assert "Drive to a place in the room." in (go.description or "")

        arrived = await model.call_tool("robot_go", {"place": "window"})
        assert (text(arrived), arrived.is_error) == ("achieved go(window)", False)

        async def hear(progress: float, total: float | None, message: str | None) -> None:
            del progress, total
            notes.append(message)

        going = asyncio.create_task(model.call_tool("robot_go", {"place": "corner"}, progress_callback=hear))

        async def on_its_way() -> bool:
            return bool(notes)

        await wait_for(on_its_way)
        going.cancel()

        async def stopped() -> bool:
            return bool(json.loads(await told(model, "goals"))[-1]["state"] == "cancelled")

        await wait_for(stopped)
        assert "go(corner)" in await told(model, "why", {"question": "why did it stop"})

        await told(model, "robot_tell_closed", {"place": "corner"})
        refused = await model.call_tool("robot_go", {"place": "corner"})
        assert (text(refused), refused.is_error) == ("refused: go(corner): closed(corner)", True)
        assert "closed(corner)" in await told(model, "why_not", {"what": "go to the corner"})
        found = await model.call_tool("robot_place", {"name": "dock"})
        assert found.structured_content == {"answers": [{"x": 1, "y": 1}]}

    errors = with_client(tmp_path, test, mode, program=ROBOT, options=WORLD)
    assert "[robot] to the window" in errors
    assert "on my way" in notes


@pytest.mark.parametrize("mode", ERAS)
def test_a_belief_is_a_resource(mode: str, tmp_path: Path) -> None:
    uri = "jacaros://robot/beliefs/lit"

    async def test(model: Client) -> None:
        assert [each.uri for each in (await model.list_resources()).resources] == [uri]
        await model.call_tool("robot_tell_lit", {"yes": True})
        (content,) = (await model.read_resource(uri)).contents
        assert {"yes": True} in json.loads(getattr(content, "text", ""))
        for wrong in (
            "jacaros://robot/beliefs/secret",
            "jacaros://eve/beliefs/lit",
            "file:///etc/passwd",
            "x",
        ):
            with pytest.raises(MCPError):
                await model.read_resource(wrong)

    with_client(tmp_path, test, mode, program=LAMP)


def test_a_client_hears_of_changes(tmp_path: Path) -> None:
    uri = "jacaros://robot/beliefs/lit"

    async def test(model: Client) -> None:
        async with model.listen(resource_subscriptions=[uri]) as events:
            await model.call_tool("robot_tell_lit", {"yes": True})
            assert await anext(aiter(events)) == ResourceUpdated(uri)

    with_client(tmp_path, test, program=LAMP)


def test_a_client_that_leaves_ends_the_run_when_its_goals_have_ended(tmp_path: Path) -> None:
    async def test(model: Client) -> None:
        asyncio.create_task(model.call_tool("robot_glow"))  # noqa: RUF006  # ends with the client
        asyncio.create_task(model.call_tool("robot_shine", {"seconds": 1}))  # noqa: RUF006

        async def both() -> bool:
            return (await told(model, "goals")).count("running") == 2

        await wait_for(both)

    errors = with_client(tmp_path, test, "legacy", program=LAMP)
    assert "[robot] dimmed" in errors
    assert "[robot] shone for 1" in errors


@pytest.mark.parametrize("wait", ["0", "0.3"])
def test_a_tool_can_return_before_the_end_of_its_goal(wait: str, tmp_path: Path) -> None:
    async def test(model: Client) -> None:
        shown = await told(model, "robot_glow")
        assert re.match("(pending|running): glow continues; its id is ", shown)
        id = shown.split("its id is ")[1].split(",")[0]
        (goal,) = json.loads(await told(model, "cancel_goal", {"id": id}))
        assert goal == {"id": id, "agent": "robot", "written": "glow", "state": "cancelled"}
        await told(model, "robot_glow")
        (goal,) = json.loads(await told(model, "cancel_goal", {"id": "all"}))
        assert goal["state"] == "cancelled"

    with_client(tmp_path, test, program=LAMP, options=("--wait", wait))


def test_wrong_calls_are_errors_in_words(tmp_path: Path) -> None:
    async def test(model: Client) -> None:
        wrong = await model.call_tool("robot_sum", {"a": "1", "c": 2})
        expected = "unknown argument `c`; `a` must be of the kind number; `b` is missing; "
        assert (wrong.is_error, text(wrong).startswith(expected)) == (True, True)
        assert "unknown argument `x`" in await told(model, "goals", {"x": 1})
        assert "`question` must be of the kind string" in await told(model, "why", {"question": 1})
        assert "no goal `none`" in await told(model, "cancel_goal", {"id": "none"})
        with pytest.raises(MCPError, match="unknown tool `robot_dim`"):
            await model.call_tool("robot_dim")

    with_client(tmp_path, test, program=LAMP)


def test_an_observer_has_no_tools_of_goals(tmp_path: Path) -> None:
    async def main() -> list[str]:
        async with client(tmp_path, program=LAMP, options=("--role", "observer")) as model:
            return [each.name for each in (await model.list_tools()).tools]

    assert asyncio.run(main()) == ["goals", "cancel_goal", "why", "why_not"]


def test_a_run_that_ends_does_not_wait_for_its_client(tmp_path: Path) -> None:
    (tmp_path / "brief.asl").write_text("!say. +!say <- .print(hello); .stopMAS.")
    command = [sys.executable, "-m", "jacaros", "mcp", str(tmp_path / "brief.asl")]
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as run:
        assert run.wait(30) == 0
        assert run.stdout is not None
        assert run.stderr is not None
        assert (run.stdout.read(), b"[brief] hello" in run.stderr.read()) == (b"", True)


@pytest.mark.parametrize(
    "line", ["x", "[" * 10_000, "{}", '{"jsonrpc": "2.0", "id": 1, "method": 3}', "x" * 3_000_000]
)
def test_a_line_that_is_not_a_message_is_answered(line: str, tmp_path: Path) -> None:
    (tmp_path / "lamp.asl").write_text(LAMP)
    command = [sys.executable, "-m", "jacaros", "mcp", str(tmp_path / "lamp.asl")]
    found = subprocess.run(command, input=f"{line}\n", capture_output=True, text=True, timeout=60, check=True)
    error = json.loads(found.stdout)["error"]
    assert error == {"code": -32700, "message": "not a JSON-RPC message of at most 1048576 bytes"}


def test_without_the_sdk_the_command_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("jacaros.runtime.cli.mcp.find_spec", lambda name: None)
    assert call(["mcp", "robot.asl"]) == 2
    expected = 'error: MCP needs the Python package mcp\n  = help: pip install "jacaros[mcp]"\n'
    assert capfd.readouterr() == ("", expected)
