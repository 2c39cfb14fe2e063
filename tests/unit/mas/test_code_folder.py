"""Generated code in a folder of the user: read only if it is certainly the user's own and complete."""

import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from jacaros.asl.loader import load_program
from jacaros.asl.nodes import Plan
from jacaros.bdi.fast.generated import unit
from jacaros.mas import code_folder
from jacaros.mas.code_folder import CodeFolder, build
from jacaros.mas.system import System
from jacaros.testing import run_project

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no generated code is kept on Windows")

PROGRAM = """
!start.
far(X) :- at(X) & X > 1.
at(2).
+!start : far(X) <- .print(X); !left(X); .stopMAS.
+!left(0).
+!left(N) <- !left(N - 1).
"""


def plans(text: str = PROGRAM) -> Sequence[Plan]:
    return load_program("robot.asl", text)[0].plans


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with an entry of a program."""
    path = tmp_path / "cache" / "plans"
    kept = CodeFolder(path)
    kept.of_program(plans()).put(b"key", b"entry")
    kept.close()
    return path


def found(folder: Path) -> bytes | None:
    return CodeFolder(folder).of_program(plans()).get(b"key")


def test_stored_code_is_found_by_the_next_run(folder: Path) -> None:
    assert found(folder) == b"entry"
    assert CodeFolder(folder).of_program(plans()).get(b"other") is None
    assert CodeFolder(folder).of_program(plans(PROGRAM + "\n")).get(b"key") is None


def test_the_folder_is_for_its_user_alone(folder: Path) -> None:
    (file,) = folder.iterdir()
    assert [path.stat().st_mode & 0o777 for path in (folder, file)] == [0o700, 0o600]


def test_entries_of_two_runs_are_kept_together(folder: Path) -> None:
    again = CodeFolder(folder)
    again.of_program(plans()).put(b"more", b"code")
    again.close()
    code = CodeFolder(folder).of_program(plans())
    assert (code.get(b"key"), code.get(b"more")) == (b"entry", b"code")


def test_a_run_that_adds_nothing_writes_nothing(folder: Path) -> None:
    before = {path.name: path.stat().st_ino for path in folder.iterdir()}
    again = CodeFolder(folder)
    assert again.of_program(plans()).get(b"key") is not None
    again.close()
    assert {path.name: path.stat().st_ino for path in folder.iterdir()} == before


@pytest.mark.parametrize(
    "damage",
    [
        lambda data: data[:-1],
        lambda data: b"",
        lambda data: data[:-1] + bytes([data[-1] ^ 1]),
        lambda data: bytes([data[0] ^ 1]) + data[1:],
        lambda data: b"\x00" * len(data),
        lambda data: data + b"\x00",
    ],
)
def test_a_damaged_file_is_ignored_and_replaced(damage: Callable[[bytes], bytes], folder: Path) -> None:
    (file,) = folder.iterdir()
    whole = file.read_bytes()
    file.write_bytes(damage(whole))
    assert found(folder) is None
    again = CodeFolder(folder)
    again.of_program(plans()).put(b"key", b"entry")
    again.close()
    assert file.read_bytes() == whole


def test_the_file_of_another_program_is_ignored(folder: Path) -> None:
    other = CodeFolder(folder)
    other.of_program(plans("+!go.")).put(b"key", b"other")
    other.close()
    first, second = folder.iterdir()
    content = first.read_bytes()
    first.write_bytes(second.read_bytes())
    second.write_bytes(content)
    assert found(folder) is None


def test_a_file_or_folder_that_others_may_write_is_ignored(folder: Path) -> None:
    (file,) = folder.iterdir()
    for path in (file, folder):
        for mode in (0o020, 0o002):
            path.chmod(path.stat().st_mode | mode)
            assert found(folder) is None
            path.chmod(path.stat().st_mode & ~mode)
    assert found(folder) == b"entry"


def test_the_folder_of_another_user_is_neither_read_nor_written(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (file,) = folder.iterdir()
    whole, owner = file.read_bytes(), os.geteuid()
    monkeypatch.setattr(os, "geteuid", lambda: owner + 1)
    assert found(folder) is None
    kept = CodeFolder(folder)
    kept.of_program(plans()).put(b"key", b"changed")
    kept.close()
    assert file.read_bytes() == whole


def test_a_symbolic_link_instead_of_a_file_is_ignored(folder: Path, tmp_path: Path) -> None:
    (file,) = folder.iterdir()
    file.rename(tmp_path / "elsewhere")
    file.symlink_to(tmp_path / "elsewhere")
    assert found(folder) is None


def test_a_folder_that_cannot_be_created_is_not_an_error(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    kept = CodeFolder(tmp_path / "file" / "plans")
    kept.of_program(plans()).put(b"key", b"entry")
    kept.close()
    assert kept.of_program(plans()).get(b"key") == b"entry"


def test_a_full_disk_is_not_an_error_and_leaves_nothing(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*paths: object) -> None:
        raise OSError(28, "No space left on device")

    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    monkeypatch.setattr(os, "replace", full)
    kept = CodeFolder(folder)
    kept.of_program(plans()).put(b"key", b"changed")
    kept.close()
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


def test_the_least_recently_used_files_are_removed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(code_folder, "LARGEST", 2500)
    texts = [f"+!go <- .print({number})." for number in range(4)]
    for number, text in enumerate(texts):
        kept = CodeFolder(tmp_path)
        kept.of_program(plans(text)).put(b"key", bytes(1000))
        kept.close()
        for path in tmp_path.iterdir():  # one hour later
            os.utime(path, (path.stat().st_mtime - 3600,) * 2)
        if number == 1:
            assert CodeFolder(tmp_path).of_program(plans(texts[0])).get(b"key") is not None
    held = [CodeFolder(tmp_path).of_program(plans(text)).get(b"key") is not None for text in texts]
    assert (held, len(list(tmp_path.iterdir()))) == ([False, False, True, True], 2)


def test_another_version_of_the_generator_has_code_of_its_own(tmp_path: Path) -> None:
    root = Path(code_folder.__file__).parent.parent
    for package in ("terms", "asl", "bdi"):
        shutil.copytree(root / package, tmp_path / package, ignore=shutil.ignore_patterns("__pycache__"))
    same = build(tmp_path)
    assert same == build(root)
    source = tmp_path / "bdi" / "fast" / "generated" / "writer.py"
    source.write_text(source.read_text() + "#")
    assert build(tmp_path) != same


def test_another_version_of_python_or_of_the_package_has_code_of_its_own(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    root = Path(code_folder.__file__).parent.parent
    builds = {build(root)}
    for holder, name, value in (
        (sys, "version", "4.0"),
        (code_folder, "VERSION", "9.9"),
        (code_folder, "MAGIC_NUMBER", b"1234"),
    ):
        with monkeypatch.context() as patch:
            patch.setattr(holder, name, value)
            builds.add(build(root))
    assert len(builds) == 4


# --- whole runs -----------------------------------------------------------------------------------------------


@pytest.fixture
def compiled(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The files of all units that are compiled in this process."""
    files: list[str] = []
    real: Callable[..., object] = unit.compile_all

    def compile_all(writers: Sequence[object], filename: str) -> object:
        files.append(filename)
        return real(writers, filename)

    monkeypatch.setattr(unit, "compile_all", compile_all)
    return files


@pytest.fixture
def program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("JACAROS_CACHE", str(tmp_path / "cache"))
    path = tmp_path / "robot.asl"
    path.write_text(PROGRAM)
    return path


def test_a_second_run_compiles_nothing(program: Path, compiled: list[str]) -> None:
    first = run_project(program)
    assert compiled
    compiled.clear()
    second = run_project(program)
    assert compiled == []
    assert (second.lines, second.exit_code) == (first.lines, first.exit_code) == (["[robot] 2"], 0)


def test_plans_without_events_are_kept_once_they_are_compiled(program: Path, compiled: list[str]) -> None:
    program.write_text("!go. +!go <- .print(going). +!other <- .print(other).")

    def compile_all(mas: System) -> None:
        while mas.lifecycle.compile_ahead():
            pass

    run_project(program, until_idle=True, when_started=compile_all)
    compiled.clear()
    project = program.with_name("robot.mas2j")
    project.write_text("MAS m { agents: robot [goals=other]; }")
    assert run_project(project, until_idle=True).lines == ["[robot] other", "[robot] going"]
    assert compiled == []


@pytest.mark.parametrize("variable", ["JACAROS_CACHE=0", "JACAROS_PLAIN=1"])
def test_nothing_is_kept_when_disabled(variable: str, program: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(program.parent / "cache"))
    monkeypatch.setenv(*variable.split("="))
    assert run_project(program).lines == ["[robot] 2"]
    assert not (program.parent / "cache").exists()


def test_nothing_is_kept_where_files_have_no_owners(program: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "win32")
    assert run_project(program).lines == ["[robot] 2"]
    assert not (program.parent / "cache").exists()


def test_it_is_in_the_folder_for_caches_of_the_user(program: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("JACAROS_CACHE")
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setenv("HOME", str(program.parent))
    run_project(program)
    assert list((program.parent / ".cache" / "jacaros" / "plans").iterdir())
    monkeypatch.setenv("XDG_CACHE_HOME", str(program.parent / "caches"))
    run_project(program)
    assert list((program.parent / "caches" / "jacaros" / "plans").iterdir())


def test_several_processes_may_begin_at_once(program: Path, compiled: list[str]) -> None:
    command = [sys.executable, "-m", "jacaros", "run", "--clock", "fast", str(program)]
    runs = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(3)]
    assert [run.communicate()[0] for run in runs] == ["[robot] 2\n"] * 3
    assert len(list((program.parent / "cache" / "plans").iterdir())) == 1
    assert run_project(program).lines == ["[robot] 2"]
    assert compiled == []
