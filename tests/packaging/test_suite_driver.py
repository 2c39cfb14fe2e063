"""The driver of the suite: nothing that fails or cannot run gets lost."""

import importlib.util
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def driver() -> ModuleType:
    spec = importlib.util.spec_from_file_location("test_all_driver", ROOT / "tools" / "test_all.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def run(
    driver: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Any:
    """Runs parts given as (name, shell command, options); gives exit code, verdicts and what was printed."""
    monkeypatch.setattr(driver, "ROOT", tmp_path)
    monkeypatch.setattr(driver, "LOGS", tmp_path / "logs")
    (tmp_path / "logs").mkdir()
    (tmp_path / "tools").mkdir()

    def call(
        *parts: tuple[str, str, dict[str, Any]], must_run: bool = False
    ) -> tuple[int, dict[str, str], str]:
        chosen = []
        for name, command, options in parts:
            script = tmp_path / "tools" / name
            script.write_text(f"#!/bin/sh\n{command}\n")
            script.chmod(0o755)
            chosen.append(driver.Part(name, (f"tools/{name}",), **options))
        suite = driver.Run(chosen, must_run)
        suite.everything()
        code = driver.report([suite.results[part.name] for part in chosen], 1.0)
        return code, {name: result.verdict for name, result in suite.results.items()}, capsys.readouterr().out

    return call


def test_a_suite_that_passes_ends_with_zero(run: Any) -> None:
    code, verdicts, printed = run(("a", "echo 3 passed in 1.0s", {}), ("b", "true", {"stage": "real-time"}))
    assert code == 0
    assert verdicts == {"a": "ok", "b": "ok"}
    assert "3 passed in 1.0s" in printed
    assert "2 parts passed, 0 failed, 0 not run" in printed


def test_all_parts_run_when_one_fails(run: Any) -> None:
    code, verdicts, printed = run(
        ("a", "echo why; exit 1", {"stage": "install"}), ("b", "true", {}), ("c", "true", {})
    )
    assert code == 1
    assert verdicts == {"a": "FAILED", "b": "ok", "c": "ok"}
    assert "why" in printed
    assert printed.rstrip().endswith("FAILED: a")


def test_parts_of_all_stages_run(run: Any) -> None:
    stages = ("install", "work", "real-time", "ros1", "ros2")
    code, verdicts, _ = run(*((stage, "true", {"stage": stage}) for stage in stages))
    assert code == 0
    assert verdicts == dict.fromkeys(stages, "ok")


def test_what_cannot_run_here_is_told_loudly(run: Any) -> None:
    code, verdicts, printed = run(("a", "exit 3", {"stage": "install"}), ("b", "true", {"needs": "a"}))
    assert code == 0
    assert verdicts == {"a": "NOT RUN", "b": "NOT RUN"}
    assert "!!!!! NOT RUN ON THIS MACHINE: a, b !!!!!" in printed


def test_on_the_build_server_what_cannot_run_is_a_failure(run: Any) -> None:
    code, verdicts, _ = run(
        ("a", "exit 3", {"stage": "install"}), ("b", "true", {"needs": "a"}), must_run=True
    )
    assert code == 1
    assert verdicts == {"a": "FAILED", "b": "FAILED"}


def test_a_skipped_test_fails_a_part_that_must_not_skip(run: Any) -> None:
    code, verdicts, _ = run(("a", "echo 2 passed, 1 skipped in 1.0s", {"skips_fail": True}))
    assert code == 1
    assert verdicts == {"a": "FAILED"}


def test_a_part_that_hangs_is_ended(run: Any) -> None:
    code, verdicts, printed = run(("a", "sleep 100", {"minutes": 0.005}))
    assert code == 1
    assert verdicts == {"a": "FAILED"}
    assert "stopped after" in printed


def test_unknown_parts_are_refused_with_the_known_ones(driver: ModuleType) -> None:
    with pytest.raises(SystemExit, match=r"no part nonsense; there are .*unit"):
        driver.choose(["nonsense"])
