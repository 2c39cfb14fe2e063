"""Files of tokens, and files that say where runs serve."""

import os
import socket
import stat
import sys
from pathlib import Path

import pytest

from jacaros.runtime.errors import JacarosError
from jacaros.serving import running
from jacaros.serving.callers import Caller
from jacaros.serving.running import RunningService
from jacaros.serving.tokens import Tokens, read_tokens

ANNA, WALL = "anna-0123456789abcdef", "wall-0123456789abcdef"
no_modes = pytest.mark.skipif(sys.platform == "win32", reason="files have no modes")


def written(folder: Path, text: str, mode: int = 0o600) -> Path:
    file = folder / "tokens.yaml"
    file.write_text(text)
    file.chmod(mode)
    return file


def test_a_file_names_callers_with_their_roles(tmp_path: Path) -> None:
    text = f"anna: {{token: {ANNA}, roles: [user, nurse]}}\nwall:\n  token: {WALL}\n  roles: [observer]\n"
    tokens = read_tokens(written(tmp_path, text))
    assert tokens.caller(ANNA, "http") == Caller("anna", "http", frozenset({"user", "nurse"}))
    assert tokens.caller(WALL, "mcp") == Caller("wall", "mcp", frozenset({"observer"}))
    assert tokens.caller(ANNA[:-1], "http") is None
    assert tokens.caller("é\ud800", "http") is None


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "the file has no tokens"),
        ("anna: {token: short, roles: [user]}", "a token is too short"),
        (f"anna: {{token: {ANNA}}}", "'anna' lacks the key 'roles'"),
        (f"anna: {{token: {ANNA}, roles: []}}", "no role"),
        (f"anna: {{token: {ANNA}, roles: [user], role: x}}", "'anna' has no key 'role'"),
        (
            f"anna: {{token: {ANNA}, roles: [user]}}\nbob: {{token: {ANNA}, roles: [user]}}",
            "`bob` has the token of `anna`",
        ),
        ("anna: [", "never closed"),
    ],
)
def test_errors_have_a_place_and_never_show_a_token(tmp_path: Path, text: str, told: str) -> None:
    with pytest.raises(JacarosError) as wrong:
        read_tokens(written(tmp_path, text))
    assert told in str(wrong.value)
    assert "tokens.yaml:" in str(wrong.value)
    assert ANNA not in str(wrong.value)


@no_modes
def test_a_file_that_others_can_read_is_refused(tmp_path: Path) -> None:
    file = written(tmp_path, f"anna: {{token: {ANNA}, roles: [user]}}", 0o640)
    with pytest.raises(JacarosError, match="other users can read the tokens") as wrong:
        read_tokens(file)
    assert f"help: chmod 600 {file}" in str(wrong.value)


def test_a_missing_file_says_how_to_write_one(tmp_path: Path) -> None:
    with pytest.raises(JacarosError, match=r"anna: \{token: …, roles: \[user\]\}"):
        read_tokens(tmp_path / "none.yaml")


def test_random_tokens_differ_and_are_those_of_operators() -> None:
    tokens = Tokens({})
    first, second = tokens.new("operator"), tokens.new("console")
    assert first != second
    assert tokens.caller(second, "console") == Caller("console", "console", frozenset({"operator"}))


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    return tmp_path / "jacaros"


def service_at(listening: socket.socket, name: str) -> RunningService:
    return RunningService(name, os.getpid(), f"http://127.0.0.1:{listening.getsockname()[1]}", ANNA)


def test_a_run_is_found_while_it_listens(folder: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listening:
        service = service_at(listening, "my robot/1")
        path = running.write(service)
        assert path == folder / f"my_robot_1-{os.getpid()}.json"
        assert running.services() == [service]
    assert running.services() == []
    assert list(folder.iterdir()) == []


def test_the_file_of_a_run_that_has_ended_is_removed(folder: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listening:
        path = running.write(service_at(listening, "robot"))
        assert path is not None
        running.remove(path)
        assert running.services() == []


@no_modes
def test_only_the_user_can_read_the_file(folder: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listening:
        path = running.write(service_at(listening, "robot"))
    assert path is not None
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700


def test_files_of_others_are_ignored(folder: Path) -> None:
    folder.mkdir()
    (folder / "x.json").write_text("{")
    (folder / "y.json").write_text('{"name": "y"}')
    assert running.services() == []
