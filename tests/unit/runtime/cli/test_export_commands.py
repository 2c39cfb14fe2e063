"""``jacaros plot`` and ``jacaros export``: files, panels and wrong names."""

import json
import sys
from pathlib import Path

import pytest
from command_lab import Outcome, Told


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A recording of two agents with batteries, in the current folder."""
    monkeypatch.chdir(tmp_path)
    lines: list[dict[str, object]] = [{"kind": "world", "version": 2, "world": {"name": "lab"}}]
    for t, agent, level in ((0.0, "one", 90), (0.0, "two", 50), (2.0, "one", 80), (3.0, "two", 40)):
        data = {"agent": agent, "op": "+", "belief": f"battery({level})"}
        gone = {"agent": agent, "op": "-", "belief": f"battery({level + 10})"}
        lines += [{"kind": "event", "t": t, "event": "belief", "data": each} for each in (gone, data)]
    Path("run.jsonl").write_text("".join(json.dumps(each) + "\n" for each in lines), encoding="utf-8")
    return tmp_path


def test_each_argument_is_a_panel(run: Path, told: Told) -> None:
    assert (
        told("plot", "run.jsonl", "battery", "one:battery,two:battery.x", "-o", "run.svg")
        == "wrote run.svg\n"
    )
    svg = Path("run.svg").read_text(encoding="utf-8")
    assert svg.count(">%</text>") == 2
    for label, times in (("one:battery", 2), ("two:battery", 1), ("two:battery.x", 1)):
        assert svg.count(f">{label}</text>") == times


def test_a_part_is_drawn_alone(run: Path, told: Told) -> None:
    told("plot", "run.jsonl", "one:battery", "-o", "all.svg")
    told("plot", "run.jsonl", "one:battery", "-o", "part.svg", "--from", "1", "--to", "1.5")
    assert ">80</text>" in Path("all.svg").read_text(encoding="utf-8")
    assert ">80</text>" not in Path("part.svg").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        (["batery"], "unknown series: `batery`\n  = help: did you mean `battery`?"),
        (["battery,"], "unknown series: ``"),
        (["battery", "--from", "3"], "--from 3 is not before the end, 3"),
        (["battery", "--from", "nan"], "--from nan is not before the end"),
        (["battery", "-o", "run.jsonl"], "`run.jsonl` exists and is not a picture"),
    ],
)
def test_wrong_usage_is_reported(run: Path, outcome: Outcome, arguments: list[str], error: str) -> None:
    code, output, errors = outcome("plot", "run.jsonl", "-o", "run.svg", *arguments)
    assert (code, output) == (2, "")
    assert errors.startswith(f"error: {error}")
    assert not Path("run.svg").exists()


def test_an_export_writes_the_messages_and_a_layout(run: Path, told: Told) -> None:
    for _ in range(2):  # its own files may be replaced
        assert told("export", "run.jsonl", "-o", "run.mcap") == "wrote run.mcap and its layout run.json\n"
    assert Path("run.mcap").read_bytes().startswith(b"\x89MCAP0\r\n")
    paths = json.loads(Path("run.json").read_text(encoding="utf-8"))["configById"]["Plot!battery"]["paths"]
    assert [each["value"] for each in paths] == ["/beliefs/one/battery.arg1", "/beliefs/two/battery.arg1"]


@pytest.mark.parametrize(
    ("output", "error"),
    [
        ("run.json", "expected a file name with the suffix .mcap, found `run.json`\n  = help: -o run.mcap"),
        ("package.mcap", "`package.json` exists and is not a layout"),
        ("no/run.mcap", "folder does not exist: `no`"),
    ],
)
def test_an_export_overwrites_nothing_else(run: Path, outcome: Outcome, output: str, error: str) -> None:
    Path("package.json").write_text('{"name": "mine"}', encoding="utf-8")
    code, _, errors = outcome("export", "run.jsonl", "-o", output)
    assert code == 2
    assert errors.startswith(f"error: {error}")
    assert Path("package.json").read_text(encoding="utf-8") == '{"name": "mine"}'
    assert not list(Path().glob("*.mcap"))


def test_an_export_without_the_library_names_the_extra(
    run: Path, outcome: Outcome, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("foxglove", "mcap_file"):
        monkeypatch.delitem(sys.modules, f"jacaros.look.out.{name}", raising=False)
    monkeypatch.setitem(sys.modules, "mcap.writer", None)
    code, _, errors = outcome("export", "run.jsonl", "-o", "run.mcap")
    assert (code, errors.splitlines()) == (
        2,
        [
            "error: mcap, which writes MCAP files, is not installed",
            "  = help: pip install 'jacaros[foxglove]'",
        ],
    )


def test_values_that_programs_compare_are_drawn_once_with_their_plans(run: Path, told: Told) -> None:
    plans = [
        {"id": 1, "label": "charge", "trigger": "+battery(B)"},
        {"id": 2, "label": "p__2", "trigger": "+!go"},
    ]
    of_plans = [
        {"belief": "battery", "argument": 0, "operator": "<", "value": 85.0, "plan": plan} for plan in (1, 2)
    ]
    of_rule = {"belief": "battery", "argument": 0, "operator": "<", "other": "limit", "rule": "low"}
    far = {"belief": "battery", "argument": 0, "operator": ">", "value": 150.0, "rule": "is_percent"}
    for agent in ("one", "two"):
        program = {"agent": agent, "plans": plans, "thresholds": [*of_plans, of_rule, far]}
        limit = {"agent": agent, "op": "+", "belief": "limit(82)"}
        with Path("run.jsonl").open("a", encoding="utf-8") as file:
            for kind, data in (("program", program), ("belief", limit)):
                file.write(json.dumps({"kind": "event", "t": 3.0, "event": kind, "data": data}) + "\n")
    told("plot", "run.jsonl", "battery", "-o", "run.svg")
    svg = Path("run.svg").read_text(encoding="utf-8")
    assert svg.count("85: @charge, +!go<") == 1
    assert svg.count("limit: low<") == 1
    assert "is_percent" not in svg, "far from the curves"
