"""``jacaros achieve``, ``ask``, ``tell`` and ``events``."""

import json
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import pytest
from console_lab import PATIENCE, ServedRun, command, program, served

from jacaros.runtime.cli.main import call

Outcome = Callable[..., tuple[int, str, str]]


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ServedRun]:
    folder = tmp_path_factory.mktemp("talking")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_RUNTIME_DIR", str(folder))
        patch.delenv("JACAROS_URL", raising=False)
        patch.delenv("JACAROS_TOKEN", raising=False)
        with served(program(folder)) as found:
            yield found


@pytest.fixture
def outcome(run: ServedRun, capsys: pytest.CaptureFixture[str]) -> Outcome:
    def call_it(*arguments: str) -> tuple[int, str, str]:
        code = call(list(arguments))
        return code, *capsys.readouterr()

    return call_it


def test_an_achieved_goal_prints_its_results(outcome: Outcome) -> None:
    assert outcome("achieve", "count(3, N)") == (0, "next = 4\n", "")
    assert outcome("achieve", "bob", "!count(3, N).") == (0, "next = 4\n", "")


def test_progress_goes_to_the_standard_error(outcome: Outcome) -> None:
    code, output, errors = outcome("achieve", 'deliver("p1", office)')
    assert (code, output) == (0, "")
    assert '[bob] !deliver("p1",office) running: 50% half way\n' in errors


def test_exit_codes_distinguish_failed_and_refused_goals(outcome: Outcome) -> None:
    code, _, errors = outcome("achieve", "lose")
    assert (code, errors.splitlines()[-1]) == (1, "[bob] !lose failed: nothing found")
    assert outcome("tell", "closed(kitchen)") == (0, "", "")
    told = '[bob] !deliver("p1",kitchen) refused: closed(kitchen)\n'
    assert outcome("achieve", 'deliver("p1", kitchen)') == (3, "", told)
    assert outcome("tell", "--untell", "closed(kitchen)") == (0, "", "")
    assert outcome("achieve", 'deliver("p1", kitchen)')[0] == 0


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no signals for other processes")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_cancels_the_goal(run: ServedRun, number: signal.Signals) -> None:
    process = subprocess.Popen(command("achieve", "search"), stderr=subprocess.PIPE, text=True)
    assert process.stderr is not None
    assert process.stderr.readline() == "[bob] !search running\n"
    process.send_signal(number)
    _, errors = process.communicate(timeout=PATIENCE)
    assert process.returncode == 4
    assert errors.endswith("[bob] !search cancelled\n")
    assert run.client.goals()[-1]["state"] == "cancelled"


def test_a_killed_client_leaves_the_goal_to_the_agent(run: ServedRun) -> None:
    process = subprocess.Popen(command("achieve", "search"), stderr=subprocess.PIPE, text=True)
    assert process.stderr is not None
    process.stderr.readline()
    process.kill()
    process.communicate(timeout=PATIENCE)
    goal = run.client.goals()[-1]
    assert goal["state"] == "running"  # the offer says `when_left(continue)`
    run.client.cancel(goal["id"])


def test_json_has_everything_about_a_goal(outcome: Outcome) -> None:
    code, output, _ = outcome("achieve", "count(3, N)", "--json")
    goal = json.loads(output)
    assert (code, goal["state"], goal["results"], goal["caller"]) == (
        0,
        "achieved",
        {"next": 4},
        "http:operator",
    )


def test_answers_are_lines_and_no_answer_is_an_exit_code(outcome: Outcome) -> None:
    assert outcome("ask", "?double(4, Y)") == (0, "Y = 8\n", "")
    assert outcome("ask", "double(4, 8)") == (0, "yes\n", "")
    assert outcome("ask", "battery(99)") == (1, "no\n", "")
    assert outcome("ask", "double(4, Y)", "--json") == (0, '[{"Y": 8}]\n', "")


def test_events_end_with_the_system(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    with served(program(tmp_path)) as run:
        process = subprocess.Popen(
            command("events", "--belief", "bob.battery"),
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        assert process.stdout is not None
        assert process.stdout.readline() == "[bob] believes battery: level = 80\n"
        deliver = partial(run.client.achieve, "bob", 'deliver("p1", office)')
        assert list(run.client.follow(deliver))[-1]["state"] == "achieved"
        lines = [process.stdout.readline()]
        while "battery" not in lines[-1]:
            lines.append(process.stdout.readline())
        run.client.achieve("bob", "halt")
        output, errors = process.communicate(timeout=PATIENCE)
    assert (process.returncode, errors) == (0, "")
    assert "[bob] announces delivered: parcel = p1\n" in [*lines, *output.splitlines(keepends=True)]
    assert lines[-1] == "[bob] believes battery: level = 50\n"


@pytest.mark.parametrize(
    ("arguments", "errors"),
    [
        (
            ("achieve", "delivr(1)"),
            "error: no agent offers a goal `delivr`\n  = help: did you mean `deliver`?\n",
        ),
        (
            ("achieve", "battery(X)"),
            "error: `battery` is a belief, not a goal\n  = help: jacaros ask 'battery(level: number)'\n",
        ),
        (
            ("ask", "rob", "battery(X)"),
            "error: no agent `rob` offers anything to you\n  = help: did you mean `bob`?\n",
        ),
        (
            ("achieve", "count(3)"),
            "error: bob offers no goal `count/1`; expected count(n: number 0..10, -> next: number)\n",
        ),
        (
            ("tell", "closed", "the", "kitchen"),
            (
                "error: expected [AGENT] and one text, found 3 words\n"
                "  = help: quote the text: jacaros tell AGENT 'name(\"text\", atom)'\n"
            ),
        ),
        (
            ("ask", "battery(X)", "--token", "guessed"),
            (
                "error: unknown token\n"
                "  = help: give the system's token: --token TOKEN, or the environment variable JACAROS_TOKEN\n"
            ),
        ),
        (
            ("ask", "battery(X)", "--url", "http://127.0.0.1:1"),
            "error: no token for http://127.0.0.1:1\n  = help: add --token TOKEN, or set JACAROS_TOKEN\n",
        ),
    ],
)
def test_mistakes_of_a_beginner_are_explained(
    outcome: Outcome, arguments: tuple[str, ...], errors: str
) -> None:
    assert outcome(*arguments) == (2, "", errors)


def test_without_a_system_the_help_starts_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    assert call(["ask", "battery(X)"]) == 2
    told = "error: no running system of this user serves callers\n  = help: jacaros run FILE --serve 0\n"
    assert capsys.readouterr().err == told


def test_several_systems_are_listed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    with served(program(tmp_path)) as bob, served(program(tmp_path, name="eve")) as eve:
        assert call(["ask", "double(1, Y)"]) == 2
        errors = capsys.readouterr().err
        assert errors.startswith("error: several running systems: ")
        assert f"bob ({bob.client.url})" in errors
        assert f"eve ({eve.client.url})" in errors
        assert call(["ask", "double(1, Y)", "--url", eve.client.url]) == 0
