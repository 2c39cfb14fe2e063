"""The plugin: agent programs are tests for pytest."""

import os
import subprocess
import sys
from pathlib import Path

import pytest


def outcome(folder: Path, *arguments: str) -> tuple[int, str]:
    """Exit code and output of pytest with this plugin and no other."""
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-p",
        "jacaros.testing.pytest_plugin",
        "-p",
        "no:cacheprovider",
    ]
    done = subprocess.run(
        [*command, *arguments],
        cwd=folder,
        env={**os.environ, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1", "PYTEST_ADDOPTS": "", "NO_COLOR": "1"},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    return done.returncode, done.stdout + done.stderr


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "test_sums.asl").write_text(
        "@adds[test] +!a <- !assert_equals(3, 1 + 2).\n@breaks[test] +!b <- .print(loud);\n !assert_equals(3, 4).",
        encoding="utf-8",
    )
    (tmp_path / "robot.asl").write_text("+!go.", encoding="utf-8")
    (tmp_path / "test_plain.py").write_text("def test_plain() -> None:\n    pass\n", encoding="utf-8")
    return tmp_path


def test_programs_are_tested_beside_python(folder: Path) -> None:
    code, output = outcome(folder, "-v")
    assert code == 1
    for line in (
        "test_sums.asl::adds PASSED",
        "test_sums.asl::breaks FAILED",
        "test_plain.py::test_plain PASSED",
    ):
        assert line in output
    assert "test_sums.asl:3:2: assert_equals failed" in output
    assert "but       was 4" in output
    assert "[test_sums] loud" in output
    assert "Traceback" not in output
    assert "pytest_plugin.py" not in output
    assert "1 failed, 2 passed" in output


def test_one_test_can_be_named(folder: Path) -> None:
    code, output = outcome(folder, "test_sums.asl::adds")
    assert code == 0
    assert "1 passed" in output
    assert "1 passed" in outcome(folder, "-k", "adds")[1]


def test_a_program_that_cannot_be_read_is_an_error(folder: Path) -> None:
    (folder / "test_wrong.asl").write_text("+!g <- .print(.", encoding="utf-8")
    code, output = outcome(folder)
    assert code == 2
    assert "test_wrong.asl:1:15: error: " in output


def test_a_label_sets_the_time_limit(folder: Path) -> None:
    (folder / "test_sums.asl").write_text("@a[test] +!a <- .wait(3000).", encoding="utf-8")
    assert outcome(folder)[0] == 0
    (folder / "test_sums.asl").write_text("@a[test, timeout(2000)] +!a <- .wait(3000).", encoding="utf-8")
    code, output = outcome(folder)
    assert code == 1
    assert "did not end within 2 s of the run's clock" in output


def test_the_plugin_imports_little() -> None:
    program = "import sys; import jacaros.testing.pytest_plugin; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    heavy = {"agents.language", "agents.mind", "runtime.mas", "robots.world"}
    imported = {name.removeprefix("jacaros.") for name in done.stdout.split()}
    assert (heavy | {"numpy", "click", "rich"}) & imported == set()
