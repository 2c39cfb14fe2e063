"""Questions about recordings of the examples, judged by the ground truth in them."""

from pathlib import Path

import pytest

from jacaros.look import Recording
from jacaros.look.records.records import Record
from jacaros.look.why.why import explain
from jacaros.runtime.cli.main import call

EXAMPLES = Path(__file__).parents[2] / "examples"
RUNS = {
    "01_out_and_back/out_and_back.jcm": 20,
    "04_patrol/patrol.jcm": 70,
    "05_house_cleaning/house_cleaning.jcm": 200,
}
"""Projects of examples, and for how many seconds they run."""


@pytest.fixture(scope="module")
def recordings(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[Record]]:
    found = {}
    for project, seconds in RUNS.items():
        run = tmp_path_factory.mktemp("run") / "run.jsonl"
        arguments = ["run", str(EXAMPLES / project), "--clock", "fast", "--seed", "1", "--for", str(seconds)]
        assert call([*arguments, "--record", str(run), "--quiet"]) == 0
        found[project[:2]] = list(Recording.read(run).events)
    return found


@pytest.mark.parametrize(
    ("example", "question", "gists"),
    [
        ("01", "why did it turn?", ["robot started `rotate(180)`", "for `!start`"]),
        ("01", "why is it standing still?", ["the run ended", "because robot ran `.stopMAS` for `!start`"]),
        ("01", "why did it fail?", ["nothing failed"]),
        ("01", "did it achieve start?", ["it ended the run with exit code 0"]),
        ("04", "why did it go to the dock?", ["`!go_to(dock)`", 'of `+diagnostics("Low Battery")`', "/battery_state"]),
        ("04", "why did it recharge?", ["echarge` at ", 'because of `+diagnostics("Low Battery")`', "with next("]),
        ("04", "why did it turn?", ["angular.z=", "for `driveTo("]),
        ("04", "did it achieve patrol?", ["no: `!patrol([1,2,3,4])` of robot was dropped", "when the run ended"]),
        ("05", "why did it go to the dock?", ["`!go_to(dock)`", '"Low Battery"']),
        ("05", "is it docked?", ["`!into_dock` of robot was achieved at", "turtlebot: docked at"]),
        ("05", "did it recharge?", ["yes: `", "echarge` of robot was "]),
        ("05", "why did it clean the kitchen?", ["`!clean_room(2,kitchen)`", "for `!clean_house`"]),
        ("05", "why did the run end?", ["`.stopMAS` for `!clean_house`", "with rounds(4)"]),
    ],
)  # fmt: skip
def test_an_answer_says_what_happened_and_why(
    recordings: dict[str, list[Record]], example: str, question: str, gists: list[str]
) -> None:
    answer = explain(recordings[example], question).text()
    assert [gist for gist in gists if gist not in answer] == []


@pytest.mark.parametrize("example", ["04", "05"])
def test_the_dock_is_reached_when_the_world_says_so(
    recordings: dict[str, list[Record]], example: str
) -> None:
    records = recordings[example]
    answer = explain(records, "did it reach the dock?")
    assert answer.answer.startswith("yes: ")
    truth = [t for t, kind, _ in records if kind == "docked"]
    assert min(abs(t - (answer.t or 0.0)) for t in truth) < 0.5
    assert explain(records, "did it reach the dock?", at=min(truth) - 15.0).answer.startswith("no: ")
