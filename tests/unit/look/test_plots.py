"""Numbers of a recording by name, and plots of them."""

import math
from xml.etree import ElementTree

import pytest

from jacaros.look.out.series import Series, all_series, named
from jacaros.look.out.svg_plot import Failure, Panel, failures, plot_svg
from jacaros.look.records.recording import Recording
from jacaros.look.records.records import Frame
from jacaros.robots.world.data.ground_truth import RobotState
from jacaros.runtime.errors import UsageError

SVG = "{http://www.w3.org/2000/svg}"


def belief(t: float, op: str, text: str, agent: str = "guard") -> tuple[float, str, dict[str, object]]:
    return t, "belief", {"agent": agent, "op": op, "belief": text}


def reading(t: float, artifact: str, *values: object) -> tuple[float, str, dict[str, object]]:
    return t, "property", {"artifact": f"/main/{artifact}", "name": "level", "values": list(values)}


RECORDING = Recording(
    world={"robots": [{"name": "r2"}]},
    frames=[Frame(float(t), [RobotState(0.5 * t, 0.0, 0.0, 90.0 - t, False, False)]) for t in range(3)],
    events=[
        belief(0.0, "+", 'battery("a,(b)",[1,2],99.5,low)[source(percept)]'),
        belief(1.0, "-", 'battery("a,(b)",[1,2],99.5,low)[source(percept)]'),
        belief(1.0, "+", 'battery("a,(b)",[1,2],-1e-3,low)[source(percept)]'),
        belief(0.0, "+", "at(1,2)"),
        belief(0.5, "-", "at(1,2)"),
        belief(0.5, "+", "at(2,2)"),
        belief(2.0, "-", "at(2,2)"),
        belief(0.0, "+", "place(dock,1)"),
        belief(0.0, "+", "place(door,2)"),
        belief(0.0, "+", "ready"),
        belief(0.0, "+", 'said("level(1)")'),
        reading(0.0, "left", 1, True),
        reading(1.5, "left", 2, True),
        reading(0.0, "right", 5),
        reading(1.0, "right", 4),
        (0.0, "laser", {"robot": "r2", "from": 0.0, "step": 1.0, "ranges": [0, 150, 90]}),
        (1.0, "laser", {"robot": "r2", "from": 0.0, "step": 1.0, "ranges": [0, 150, 80]}),
    ],
)


def points(name: str) -> list[list[tuple[float, float]]]:
    return [each.points for each in named(all_series(RECORDING), name)]


@pytest.mark.parametrize(
    ("name", "found"),
    [
        ("battery", [[(0.0, 99.5), (1.0, -0.001)]]),
        ("guard:battery.3", [[(0.0, 99.5), (1.0, -0.001)]]),
        ("battery.yaw", [[(0.0, 99.5), (1.0, -0.001)]]),
        ("level", [[(0.0, 1.0), (1.5, 2.0)], [(0.0, 5.0), (1.0, 4.0)]]),
        ("right:level.1", [[(0.0, 5.0), (1.0, 4.0)]]),
        ("r2.x", [[(0.0, 0.0), (1.0, 0.5), (2.0, 1.0)]]),
        ("r2.speed", [[(0.0, 0.5), (1.0, 0.5), (2.0, 0.0)]]),
        ("r2.laser", [[(0.0, 0.9), (1.0, 0.8)]]),
    ],
)
def test_a_name_means_numbers(name: str, found: list[list[tuple[float, float]]]) -> None:
    assert points(name) == found


def test_a_removed_value_ends_its_curve() -> None:
    ((*_, (t, last)),) = points("at")
    assert t == 2.0
    assert math.isnan(last)


@pytest.mark.parametrize(
    "name", ["batery", "guard:level", "battery.1", "r2.z", "place", "", ":", "left:level.2"]
)
def test_an_unknown_name_lists_the_known_ones(name: str) -> None:
    with pytest.raises(UsageError, match=r"unknown series: .*\n  = help: .*battery, .*r2\.battery.*level"):
        points(name)


def drawn(
    *curves: Series, failed: list[Failure] | None = None, end: float = 2.0, start: float = 0.0
) -> ElementTree.Element:
    panel = Panel(
        [(f"{each.owner}: {each.name}.{each.field}", each) for each in curves],
        [("20 & less", Series("limit", "", "20", "", [(0.0, 20.0)]))],
    )
    return ElementTree.fromstring(plot_svg([panel], failed or [], (start, end), "<run>"))


def marks(svg: ElementTree.Element, kind: str) -> list[str]:
    return [each.attrib["d"] for each in svg.iter(f"{SVG}path") if each.get("class") == kind]


def test_a_plot_shows_curves_thresholds_and_labels() -> None:
    svg = drawn(*named(all_series(RECORDING), "battery"), *named(all_series(RECORDING), "r2.x"))
    texts = [each.text for each in svg.iter(f"{SVG}text")]
    assert {"guard: battery.3", "r2: r2.x", "20 & less", "%, m", "time (s)"} <= {*texts}
    assert len(marks(svg, "limit")) == 1
    stepped, moving = [each for each in marks(svg, "curve") if not each.endswith("h24")]
    assert "L" not in stepped
    assert moving.count("L") == 2


def test_a_plot_marks_failures_and_tells_handled_ones_apart() -> None:
    goal = {"agent": "guard", "goal": "!go", "id": 1}
    events = [(0.5, "goal", {**goal, "state": "failed"}), (0.5, "goal", {**goal, "state": "recovered"})]
    events += [(1.0, "goal", {**goal, "id": 2, "state": "failed"})]
    failed = failures(events)
    assert failed == [Failure(0.5, "!go", True), Failure(1.0, "!go", False)]
    svg = drawn(*named(all_series(RECORDING), "r2.x"), failed=failed)
    assert [len(marks(svg, kind)) for kind in ("handled", "failed")] == [2, 2]  # one each is in the legend
    assert "1 × !go failed, then handled" in [each.text for each in svg.iter(f"{SVG}text")]


def test_texts_of_a_recording_cannot_break_a_plot() -> None:
    evil = "\x1b[2J</text><script>alert(1)</script>&\udcff"
    svg = drawn(*named(all_series(RECORDING), "r2.x"), failed=[Failure(0.5, evil, False)])
    assert not list(svg.iter(f"{SVG}script"))
    assert max(len(each.text or "") for each in svg.iter(f"{SVG}text")) < 60
    assert any("<script>" in (each.text or "") for each in svg.iter(f"{SVG}text"))


def test_a_long_curve_has_few_points_and_keeps_its_peaks() -> None:
    series = Series("belief", "guard", "level", "1", [(float(t), t % 7.0) for t in range(100_000)])
    series.points[50_000] = (50_000.0, 99.0)
    curve = marks(drawn(series, end=100_000.0), "curve")[1]
    assert len(curve) < 100_000
    top = min(float(each.partition("H")[0]) for each in curve.split("V")[1:])
    assert curve.count(f"V{top:g}") == 1


@pytest.mark.parametrize("value", [0.0, -3.5, 1e-9, 1e12])
def test_a_curve_that_does_not_change_has_an_axis(value: float) -> None:
    panel = Panel([("level", Series("belief", "guard", "level", "1", [(0.0, value)]))])
    assert "nan" not in plot_svg([panel], [], (0.0, 0.0), "run")


def test_a_part_of_a_run_begins_with_the_value_that_holds_then() -> None:
    (level,) = named(all_series(RECORDING), "left:level")
    assert level.between(1.0, 1.2).points == [(1.0, 1.0)]
    assert level.between(1.5, 9.0).points == [(1.5, 2.0)]
    svg = drawn(level, failed=[Failure(0.5, "!go", False)], start=1.0)
    assert marks(svg, "failed") == []
    assert "1.2" in [each.text for each in svg.iter(f"{SVG}text")]
