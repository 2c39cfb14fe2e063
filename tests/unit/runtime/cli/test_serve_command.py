"""``jacaros run --serve``: its options, what it logs, and the private file by which the console finds it."""

import json
import os
import re
import socket
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest
from command_lab import Outcome

PROGRAM = "{ offer(belief, battery(level(number))) } battery(80)."


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "hello.asl").write_text("!hi. +!hi <- .print(hi).", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    return tmp_path


@pytest.mark.parametrize(
    ("options", "told", "help"),
    [
        (("--tokens", "t.yaml"), "--tokens needs --serve", "add --serve 8000"),
        (("--serve", "x"), "expected [ADDRESS:]PORT", ""),
        (("--serve", "70000"), "at most 65535", ""),
        (("--serve", "0", "--tls-cert", "c.pem"), "HTTPS needs a certificate and its key", "--tls-key FILE"),
        (
            ("--serve", "0", "--tokens", "none.yaml"),
            "cannot read none.yaml",
            "write a file with lines such as",
        ),
        (("--serve", "0", "--all-nodes"), "--serve serves one node", "--node NAME"),
        (("--serve", "192.0.2.1:0"), "cannot serve HTTP at 192.0.2.1:0", "choose another address"),
    ],
)
def test_options_that_do_not_fit(
    folder: Path, outcome: Outcome, options: tuple[str, ...], told: str, help: str
) -> None:
    code, _, errors = outcome("run", "hello.asl", *options)
    assert code in (1, 2)
    assert told in errors
    assert help in errors


def test_a_missing_extra_is_named(folder: Path, outcome: Outcome, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("jacaros.runtime.cli.serving.find_spec", lambda _: None)
    code, _, errors = outcome("run", "hello.asl", "--serve", "0")
    assert code == 2
    assert 'help: pip install "jacaros[serve]"' in errors


def test_a_run_serves_and_leaves_a_private_file_until_its_end(tmp_path: Path) -> None:
    (tmp_path / "robot.asl").write_text(PROGRAM, encoding="utf-8")
    command = (sys.executable, "-m", "jacaros", "run", "robot.asl", "--serve", "0")
    environment = {**os.environ, "XDG_RUNTIME_DIR": str(tmp_path)}
    with subprocess.Popen(command, cwd=tmp_path, env=environment, stderr=subprocess.PIPE, text=True) as run:
        assert run.stderr is not None
        lines = [next(run.stderr), next(run.stderr)]
        try:
            found = re.fullmatch(r"serve: (http:[/]{2}127\.0\.0\.1:\d+)\n", lines[0])
            token = re.fullmatch(r"serve: the token of an operator is (\S+)\n", lines[1])
            assert found, lines
            assert token, lines
            file = tmp_path / "jacaros" / f"robot-{run.pid}.json"
            service = json.loads(file.read_text())
            assert (service["url"], service["token"]) == (found[1], token[1])
            asked = urllib.request.Request(
                f"{found[1]}/agents/robot/beliefs/battery", headers={"Authorization": f"Bearer {token[1]}"}
            )
            with urllib.request.urlopen(asked) as response:
                assert json.load(response) == {"beliefs": [{"level": 80}]}
        finally:
            run.terminate()
        rest = run.stderr.read()
    assert not file.exists()
    assert "nothing left to do" not in rest


def test_a_run_for_other_machines_warns_without_tls(folder: Path, outcome: Outcome) -> None:
    code, _, errors = outcome("run", "hello.asl", "--serve", "0.0.0.0:0", "--until-idle")
    assert code == 0
    assert "warning: the connection is not encrypted: others who read the traffic to 0.0.0.0" in errors
    assert "help: add --tls-cert FILE --tls-key FILE" in errors
    assert socket.gethostname() in errors
