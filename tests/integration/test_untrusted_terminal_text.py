"""No command writes a control character of a file, a message or a name to the terminal."""

import json
import os
import re
import subprocess
import sys

import pytest

from jacaros.runtime.cli.main import COMMANDS

EVIL = "\x1b]0;owned\x07\x1b[2J\x9b31m\x7f\u202e"
OBEYED = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202e]")
JSON_EVIL = json.dumps(EVIL)[1:-1]

PROGRAM = f"""
said("{EVIL}").
!s.
+!s <- .print("{EVIL}"); .log(warning, "{EVIL}"); !deliver("{EVIL}"); .wait(100000).
+!deliver(X) <- .wait({{+never(X)}}).
"""
TESTS = f"""
{{ include("$jacaros/tester_agent.asl") }}
@[test] +!test_evil <- .print("{EVIL}"); !assert_equals("{EVIL}", 1).
"""
WORLD = f"""
name: "{JSON_EVIL}"
bounds: {{from: [0, 0], to: [4, 4]}}
rooms: [{{name: "r{JSON_EVIL}", from: [0, 0], to: [2, 2]}}]
robots: [{{name: r, pose: {{x: 1, y: 1, yaw_degrees: 0}}}}]
"{JSON_EVIL}": 1
"""
MAPPING = f'artifacts: {{"{JSON_EVIL}": {{properties: {{"{JSON_EVIL}": {{topic: "/x{JSON_EVIL}"}}}}}}}}\n'

NOWHERE = ("--url", "http://127.0.0.1:1", "--token", "0123456789abcdef")

RUNS: dict[str, list[list[str]]] = {
    "run": [["run", "a.asl", "--clock", "fast", "--world", "none", "--for", "2"], ["run", f"b{EVIL}.asl"]],
    "test": [["test", "tests.asl"], ["test", "-v", "tests.asl"]],
    "check": [["check", "a.asl"], ["check", "w.yaml"], ["check", "m.yaml"], ["check", EVIL]],
    "describe": [["describe", "a.asl"], ["describe", "a.asl", "--json"], ["describe", "m.yaml"]],
    "fmt": [["fmt", "--check", "a.asl"], ["fmt", "broken.asl"]],
    "view": [
        ["view", "r.jsonl", "--output", f"{EVIL}/r.html"],
        ["view", "damaged.jsonl", "--output", "x.html"],
    ],
    "why": [["why", "r.jsonl", "waiting"], ["why", "r.jsonl", EVIL], ["why", "r.jsonl", "waiting", "--json"]],
    "plot": [
        ["plot", "r.jsonl", EVIL, "-o", "x.svg"],
        ["plot", "damaged.jsonl", "battery", "-o", f"{EVIL}/x.svg"],
    ],
    "export": [["export", "r.jsonl", "-o", EVIL], ["export", "damaged.jsonl", "-o", f"{EVIL}/x.mcap"]],
    "replay": [["replay", "r.jsonl", "--against", "other.asl"], ["replay", "r.jsonl", "--against", EVIL]],
    "world": [["world", "show", "w.yaml"], ["world", "list", EVIL]],
    "sim": [["sim", "w.yaml"], ["sim", EVIL]],
    "ros": [["ros", "list", "--world", "w.yaml"], ["ros", "show", EVIL], ["ros", "check", "m.yaml"]],
    "guard": [["guard", EVIL]],
    "fleet": [
        ["fleet", "list", EVIL],
        ["fleet", "stop", "lab", EVIL],
        ["fleet", "keys", "lab", EVIL, "--folder", "keys"],
        ["fleet", "router", "lab", "--listen", EVIL],
        ["run", "a.asl", "--fleet", "lab", "--member", EVIL],
        ["run", "a.asl", "--fleet", "lab", "--fleet-allow", EVIL],
    ],
    "demo": [["demo", EVIL]],
    "port": [["port", "Evil.java"], ["port", EVIL], ["port", "Evil.java", "-o", f"{EVIL}/x.py"]],
    "new": [["new", EVIL], ["new", "robot", "--template", EVIL]],
    "mcp": [["mcp", EVIL]],
    "dap": [["dap", EVIL]],
    "lsp": [["lsp", EVIL]],
    "achieve": [["achieve", EVIL, *NOWHERE], ["achieve", EVIL, "go", *NOWHERE]],
    "ask": [["ask", EVIL, *NOWHERE], ["ask", "p(X)", "--url", EVIL, "--token", EVIL]],
    "tell": [["tell", EVIL, *NOWHERE]],
    "events": [["events", EVIL, *NOWHERE], ["events", "--belief", EVIL, *NOWHERE]],
    "console": [["console", EVIL], ["console", f"http://127.0.0.1:1/{EVIL}"]],
    "version": [["version", EVIL]],
}


EACH = """
import json, sys
from jacaros.runtime.cli.main import main
streams = sys.stdout, sys.stderr
for arguments in json.loads(sys.argv[1]):
    sys.stdout, sys.stderr = streams
    print("=" * 20, json.dumps(arguments), flush=True)
    try:
        main(arguments)
    except SystemExit:
        sys.stdout.flush()
"""
RECORD = [*RUNS["run"][0], "--record", "r.jsonl"]


@pytest.fixture(scope="module")
def outputs(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """What each command prints, to both outputs; by its arguments as JSON."""
    folder = tmp_path_factory.mktemp("evil")
    files = {
        "a.asl": PROGRAM,
        "other.asl": f'!s.\n+!s <- .print("{EVIL}").\n',
        "broken.asl": f'!s.\n+!s <- "{EVIL}" ++.\n',
        "tests.asl": TESTS,
        "w.yaml": WORLD,
        "m.yaml": MAPPING,
        "Evil.java": f"class Evil extends Artifact {{ {EVIL}",
        "damaged.jsonl": f'{{"kind": "world", "version": 2, "world": {{"name": "{JSON_EVIL}"}}}}\n{EVIL}\n',
    }
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8")
    commands = [RECORD, *(each for runs in RUNS.values() for each in runs)]
    ended = subprocess.run(
        [sys.executable, "-c", EACH, json.dumps(commands)],
        cwd=folder,
        env={**os.environ, "PYTHONUTF8": "1"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        timeout=300,
        check=False,
    )
    assert JSON_EVIL[:12] in (folder / "r.jsonl").read_text(encoding="utf-8")
    parts = ended.stdout.decode("utf-8", "replace").split("=" * 20 + " ")[1:]
    return {part.partition("\n")[0]: part.partition("\n")[2] for part in parts}


def test_every_command_is_tried() -> None:
    assert set(RUNS) == set(COMMANDS)


@pytest.mark.parametrize("command", RUNS)
def test_no_control_character_reaches_the_terminal(outputs: dict[str, str], command: str) -> None:
    for arguments in RUNS[command]:
        output = outputs[json.dumps(arguments)]
        assert output, arguments
        assert OBEYED.findall(output) == [], arguments


def test_what_an_agent_prints_is_shown_escaped(outputs: dict[str, str]) -> None:
    shown = r"[a] \x1b]0;owned\x07\x1b[2J\u009b31m\u007f\u202e"
    assert shown in outputs[json.dumps(RUNS["run"][0])]


def test_json_for_programs_stays_json(outputs: dict[str, str]) -> None:
    answer = json.loads(outputs[json.dumps(["why", "r.jsonl", "waiting", "--json"])])
    assert EVIL in str(answer) or "owned" in str(answer)
