"""The engines of the benchmarks run in separate processes, and their output is parsed."""

import sys
from pathlib import Path
from typing import Any

import pytest
from mind import engines
from mind.workloads import WORKLOADS

JASON = """\
#!/bin/sh
# Tells what Jason would.
test "$2" = --no-net || exit 3
grep -q "MAS bench" "$1" || exit 4
echo "Runtime Services (RTS) is running"
for round in 1 2 3; do
  echo "[bench] begin"
  echo "[bench] end 7.0"
done
"""
COUNT = WORKLOADS[0]


@pytest.fixture(autouse=True)
def sources(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[3] / "src"))


def fake_jason(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, script: str) -> None:
    file = tmp_path / "jason"
    file.write_text(script, encoding="utf-8")
    file.chmod(0o755)
    monkeypatch.setenv("JASON", str(file))


def test_our_engine_reports_its_figures() -> None:
    found = engines.run(engines.OURS, COUNT, 50)
    assert found["times"] == engines.MOST_TIMES
    assert found["results"] == [""] * engines.MOST_TIMES
    assert found["cycles"] > 50 * engines.MOST_TIMES
    assert found["seconds"] > 0
    assert found["calls"] > 50


@pytest.mark.skipif(sys.platform == "win32", reason="replaces Jason by a POSIX script")
def test_jason_runs_if_it_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    fake_jason(tmp_path, monkeypatch, JASON)
    assert engines.JASON in engines.available()
    found = engines.run(engines.JASON, COUNT, 50)
    assert (found["times"], found["results"]) == (3, ["7", "7", "7"])
    assert found["start"] > 0


@pytest.mark.skipif(sys.platform == "win32", reason="replaces Jason by a POSIX script")
def test_a_failing_engine_reports_why(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    fake_jason(tmp_path, monkeypatch, "#!/bin/sh\necho there is no java\nexit 1\n")
    found = engines.run(engines.JASON, COUNT, 50)
    assert found["note"] == "fails"
    assert "there is no java" in found["why"]


def test_an_engine_that_never_ends_is_stopped(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(engines.PATIENCE, engines.OURS, 1.0)

    def endless(*arguments: Any) -> list[str]:
        del arguments
        script = "import sys\nprint('begin 0.25', file=sys.stderr, flush=True)\nwhile True: pass\n"
        return [sys.executable, "-c", script]

    monkeypatch.setattr(engines, "_command", endless)
    assert engines.run(engines.OURS, COUNT, 50) == {"note": "> 1 s", "at_least": 0.75}
