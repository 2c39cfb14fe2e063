"""The driver of the suite: nothing that fails or cannot run gets lost."""

import contextlib
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from hypothesis import HealthCheck, settings
from loading import loaded


@pytest.fixture(scope="module")
def driver() -> ModuleType:
    return loaded("test_all")


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


INSTALL: dict[str, Any] = {"stage": "install"}
STAGES = ("install", "work", "waiting", "real-time")
CANNOT = ("a", "exit 3", INSTALL), ("b", "true", {"needs": "a"})
SLOW = "for i in 1 2 3 4 5 6; do echo $i; sleep 0.4; done"
SUITES: dict[str, tuple[Any, ...]] = {
    "a passing suite exits with 0": (
        [("a", "echo 3 passed in 1.0s", {}), ("b", "true", {"stage": "real-time"})],
        *(0, ["ok", "ok"], ["3 passed in 1.0s", "2 parts passed, 0 failed, 0 not run"]),
    ),
    "all parts run when one fails": (
        [("a", "echo why; exit 1", INSTALL), ("b", "true", {}), ("c", "true", {})],
        *(1, ["FAILED", "ok", "ok"], ["why", "FAILED: a\n"]),
    ),
    "parts of all stages run": ([(each, "true", {"stage": each}) for each in STAGES], 0, ["ok"] * 4, []),
    "what cannot run here is reported prominently": (
        *(CANNOT, 0, ["NOT RUN", "NOT RUN"], ["!!!!! NOT RUN ON THIS MACHINE: a, b !!!!!"]),
    ),
    "a skipped test fails a part that must not skip": (
        [("a", "echo 2 passed, 1 skipped in 1.0s", {"skips_fail": True})],
        *(1, ["FAILED"], []),
    ),
    "a part that makes no progress is stopped": (
        [("a", "echo begun; sleep 100", {"quiet_minutes": 0.005})],
        *(1, ["FAILED"], ["stopped: no output for 0.005 minutes"]),
    ),
    "a part may take long while it makes progress": (
        *([("a", SLOW, {"quiet_minutes": 2 / 60})], 0, ["ok"], []),
    ),
}


@pytest.mark.parametrize("suite", SUITES)
def test_a_suite_has_an_exit_code_verdicts_and_a_report(run: Any, suite: str) -> None:
    parts, code, verdicts, words = SUITES[suite]
    names = [name for name, _, _ in parts]
    found, given, printed = run(*parts)
    assert (found, given) == (code, dict(zip(names, verdicts, strict=True)))
    assert [each for each in words if each not in printed] == []
    assert "FAILED: a\n" not in words or printed.rstrip().endswith("FAILED: a")


def test_on_the_build_server_a_part_that_cannot_run_fails(run: Any) -> None:
    assert run(*CANNOT, must_run=True)[:2] == (1, {"a": "FAILED", "b": "FAILED"})


def test_a_part_that_uses_too_much_processor_time_is_stopped(run: Any, tmp_path: Path) -> None:
    # A child of a child, in a session of its own: all that a part starts counts.
    endless = "setsid sh -c 'echo $$ >endless; while :; do :; done' & wait"
    code, verdicts, printed = run(("a", endless, {"budget": 0.05}))
    assert code == 1
    assert verdicts == {"a": "FAILED"}
    state = Path("/proc", (tmp_path / "endless").read_text().strip(), "stat")
    with contextlib.suppress(OSError):
        while state.read_text().rpartition(")")[2].split()[0] != "Z":
            pass  # a signal takes a moment
    assert "s of processor time, 5 times its budget" in printed


def test_the_closing_table_shows_parts_that_have_become_slow(driver: ModuleType, capsys) -> None:
    slow, fast = driver.Part("slow", ("true",), budget=20), driver.Part("fast", ("true",), budget=30)
    results = [driver.Result(part, "ok", 60.0, 35.0, "3 passed") for part in (slow, fast)]
    assert driver.report(results, 60.0) == 0
    printed = capsys.readouterr().out
    assert "slow                         60 s      35 s     20 s  3 passed" in printed
    assert "over their budget of processor time by half: slow\n" in printed


def test_repeats_run_only_when_all_is_asked_for(driver: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    known = [driver.Part("unit", ("true",)), driver.Part("again", ("true",), needs="unit", repeats=True)]
    monkeypatch.setattr(driver, "parts", lambda: known)
    assert driver.choose([]) == known[:1]
    assert driver.choose([], repeats=True) == known
    assert driver.choose(["again"]) == known


def test_properties_have_the_same_examples_in_every_run_however_slow_the_machine() -> None:
    assert settings.default is not None
    assert settings.default.deadline is None
    assert settings.default.derandomize
    assert HealthCheck.too_slow in settings.default.suppress_health_check


def test_unknown_parts_are_rejected_with_the_known_ones(driver: ModuleType) -> None:
    with pytest.raises(SystemExit, match=r"no part nonsense; there are .*unit"):
        driver.choose(["nonsense"])


def test_the_table_of_coverage_has_a_row_for_each_package() -> None:
    def lines(run: int, of: int) -> dict[str, dict[str, int]]:
        return {"summary": {"covered_lines": run, "num_statements": of}}

    files = {
        "src/jacaros/version.py": lines(1, 1),
        "src/jacaros/agents/mind/mind.py": lines(3, 4),
        "src/jacaros/agents/mind/rules/cycle.py": lines(1, 5),
        "src/jacaros/agents/mind/rules/query.py": lines(4, 5),
    }
    assert loaded("measure_coverage").table(files)[2:] == [
        "| agents | 4 | 75 % |",
        "| agents/mind/rules | 10 | 50 % |",
        "| jacaros | 1 | 100 % |",
        "| all | 15 | 60 % |",
    ]
