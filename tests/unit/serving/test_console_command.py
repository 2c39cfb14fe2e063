"""``jacaros console``: scripts, and a person at a terminal."""

import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from console_lab import PATIENCE, Screen, ServedRun, command, program, served
from prompt_toolkit.completion import CompleteEvent
from prompt_toolkit.document import Document

from jacaros.runtime.errors import UsageError
from jacaros.serving.client import Client, Offered
from jacaros.serving.shell.choice import GOALS, chosen
from jacaros.serving.shell.dialogue import KEPT, Dialogue, written
from jacaros.serving.shell.terminal import OfferCompleter

OpenScreen = Callable[..., Screen]


@pytest.fixture(autouse=True)
def _private_folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    monkeypatch.setenv("JACAROS_CACHE", str(tmp_path / "cache"))


@pytest.fixture
def run(tmp_path: Path) -> Iterator[ServedRun]:
    with served(program(tmp_path)) as found:
        yield found


@pytest.fixture
def screen() -> Iterator[OpenScreen]:
    if sys.platform == "win32":
        pytest.skip("Windows has no pseudo-terminals")
    with ExitStack() as stack:

        def open_it(*arguments: str) -> Screen:
            found = Screen(*arguments)
            stack.callback(found.close)
            return found

        yield open_it


def script(lines: str, *arguments: str) -> tuple[int, str]:
    ended = subprocess.run(
        command("console", *arguments),
        input=lines,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
    )
    return ended.returncode, ended.stdout


# ---- scripts


def test_a_script_waits_for_each_goal(run: ServedRun) -> None:
    code, output = script('!deliver("p1", kitchen)\n?battery(X)\n+closed(kitchen)\n!deliver("p1", kitchen)\n')
    lines = [each for each in output.splitlines() if not each.endswith(" running")]  # it may be skipped
    assert lines == [
        '[bob] goal 1 !deliver("p1",kitchen) running: 50% half way',
        '[bob] goal 1 !deliver("p1",kitchen) achieved',
        "X = 50",
        '[bob] goal 2 !deliver("p1",kitchen) refused: closed(kitchen)',
    ]
    assert code == 1  # of the refused goal


def test_a_script_runs_a_file_to_the_end_of_the_script(tmp_path: Path) -> None:
    code, output = script("bob !count(3, N)\nquit\n!search\n", str(program(tmp_path)), "--seed", "1")
    assert (code, output) == (0, "[bob] goal 1 !count(3,N) achieved: next = 4\n")


def test_the_lists_of_a_console(run: ServedRun) -> None:
    code, output = script(
        "agents\nbeliefs\n!count(1, N)\ngoals\nquestions\nwhy !count(_, _)\n// a comment\n\n"
    )
    assert code == 0
    assert (
        "bob\n  goal           !deliver(parcel: string, room: kitchen | office)  Bring a parcel to a room.\n"
        in output
    )
    assert "[bob] battery: level = 80\n" in output
    assert "  1  [bob] !count(1,N) for http:operator: achieved: next = 2\n" in output
    assert "no open questions\n" in output
    assert "asked by http:operator: !count(1," in output


def test_an_unknown_command_is_an_error(run: ServedRun) -> None:
    code, output = script("gaols\ncancel 7\n")
    assert code == 1
    assert output.splitlines() == [
        "error: unknown command: `gaols`",
        "  = help: did you mean `goals`?",
        "error: unknown goal: `7`",
        "  = help: no goal has been given",
    ]


def test_a_question_to_a_person_is_answered(tmp_path: Path) -> None:
    asking = """
        { include("$jacaros/artifacts.asl") }
        { offer(belief, chosen(room(any))) }
        !ask.
        +!ask <- !use_artifact("operator", "Operator"); ask("Where?", [kitchen, hall], Room); +chosen(Room).
    """
    with served(program(tmp_path, asking)) as run, run.client.events(["bob.chosen"]) as events:
        assert next(events)["beliefs"] == []
        while not run.client.questions():
            pass
        assert script("questions\nanswer operator-1 2\n") == (0, "operator-1: Where? 1) kitchen 2) hall\n")
        assert next(events)["beliefs"] == [{"room": "hall"}]


# ---- a person at a terminal


def test_a_person_runs_a_file_and_talks_to_it(tmp_path: Path, screen: OpenScreen) -> None:
    terminal = screen("console", str(program(tmp_path)))
    terminal.wait_for("agents: bob; `help` lists what you can write")
    terminal.wait_for(">")
    terminal.type('!deliver("p1", office)\r')
    terminal.wait_for('[bob] goal 1 !deliver("p1",office) running: 50% half way')
    terminal.wait_for("[bob] announces delivered: parcel = p1")
    terminal.wait_for('[bob] goal 1 !deliver("p1",office) achieved')
    terminal.type("!search\r")
    terminal.wait_for("[bob] goal 2 !search running")
    terminal.type("\x03")  # clears the line
    terminal.type("cancel 2\r")
    terminal.wait_for("[bob] goal 2 !search cancelled")
    terminal.type("\x04")
    assert terminal.end() == 0
    assert terminal.echoes


def test_the_end_of_the_run_ends_its_console(tmp_path: Path, screen: OpenScreen) -> None:
    terminal = screen("console", str(program(tmp_path)))
    terminal.wait_for("lists what you can write")
    terminal.wait_for(">")
    terminal.type("!halt\r")
    assert terminal.end() == 7
    assert terminal.echoes


def test_sigterm_ends_run_and_console(tmp_path: Path, screen: OpenScreen) -> None:
    terminal = screen("console", str(program(tmp_path)))
    terminal.wait_for("lists what you can write")
    terminal.wait_for(">")
    terminal.terminate()
    assert terminal.end() == 143
    assert terminal.echoes


def test_a_console_shows_goals_of_others_until_the_system_ends(run: ServedRun, screen: OpenScreen) -> None:
    terminal = screen("console", run.client.url)
    terminal.wait_for("lists what you can write")
    terminal.wait_for(">")
    run.client.achieve("bob", "count(1, N)")
    terminal.wait_for("[bob] goal 1 !count(1,N) achieved: next = 2")
    run.kill()
    terminal.wait_for("the system has ended")
    assert terminal.end() == 0
    assert terminal.echoes


def test_a_console_remembers_lines(run: ServedRun, screen: OpenScreen) -> None:
    for keys in ("?double(4, Y)\r", "\x1b[A\r"):  # the arrow up
        terminal = screen("console")
        terminal.wait_for("lists what you can write")
        terminal.wait_for(">")
        terminal.type(keys)
        terminal.wait_for("Y = 8")
        terminal.type("\x04")
        assert terminal.end() == 0


def test_without_prompt_toolkit_the_help_installs_it(
    screen: OpenScreen, monkeypatch: pytest.MonkeyPatch
) -> None:
    lacking = (
        "import sys; sys.modules['prompt_toolkit'] = None; from jacaros.runtime.cli.main import main; main()"
    )
    monkeypatch.setattr("console_lab.command", lambda *words: [sys.executable, "-c", lacking, *words])
    terminal = screen("console")
    terminal.wait_for("error: the console needs prompt_toolkit")
    terminal.wait_for('= help: pip install "jacaros[console]"')
    assert terminal.end() == 2


# ---- parts


OFFERS = [
    Offered("bob", "goal", "deliver", "deliver(parcel: string, room: lab | hall)", "", ((), ("lab", "hall"))),
    Offered("bob", "tell", "closed", "closed(room: atom)", "", ((),)),
    Offered("eve", "goal", "deliver", "deliver(parcel: string)", "", ((),)),
    Offered("eve", "goal", "dance", "dance", "", ()),
]


@pytest.mark.parametrize(
    ("text", "completions"),
    [
        ("go", ["goals"]),
        ("!d", ["!deliver(", "!deliver(", "!dance"]),
        ("-cl", ["-closed("]),
        ('!deliver("p1", ', ["lab", "hall"]),
        ('!deliver("p1", h', ["hall"]),
        ("", []),
    ],
)
def test_what_is_offered_is_completed(text: str, completions: list[str]) -> None:
    dialogue = Dialogue(Client("http://127.0.0.1:1", ""), print, waits=False)
    dialogue.offers = OFFERS
    found = OfferCompleter(dialogue).get_completions(Document(text), CompleteEvent())
    assert [each.text for each in found] == completions


def test_an_agent_is_named_only_if_several_offer_the_goal() -> None:
    assert chosen(OFFERS, GOALS, "dance", "", written).agent == "eve"
    assert chosen(OFFERS, GOALS, "deliver(1)", "bob", written).agent == "bob"
    with pytest.raises(UsageError) as raised:
        chosen(OFFERS, GOALS, 'deliver("p1")', "", written)
    assert str(raised.value).splitlines() == [
        "error: bob, eve offer the goal `deliver`",
        '  = help: name the agent: bob !deliver("p1")',
    ]


def test_numbers_of_old_goals_are_forgotten() -> None:
    dialogue = Dialogue(Client("http://127.0.0.1:1", ""), print, waits=False)
    goal = {
        "event": "goal",
        "agent": "bob",
        "written": "go",
        "state": "running",
        "progress": None,
        "note": "",
    }
    lines = [dialogue.event({**goal, "id": str(number)}) for number in range(KEPT + 5)]
    assert lines[-1] == f"[bob] goal {KEPT + 5} !go running"
    assert dialogue.event({**goal, "id": str(KEPT)}) == ""  # nothing new
    assert dialogue.event({**goal, "id": "0"}) != ""  # forgotten, so new again
