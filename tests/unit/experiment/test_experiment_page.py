"""The page of the experiment and its pictures, on made-up runs."""

import re
from xml.etree import ElementTree

import pytest
from made_up import outcomes

import page
from family import DONE, ENDS, count, family
from figures import differences, outcomes_by_side, responses
from record import Outcome
from response import DOSES
from scenarios import FOLDER, SCENARIOS

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def record() -> list[Outcome]:
    return outcomes(40)


def titles(svg: str, shape: str) -> list[str]:
    """What each shape of a picture shows beside the pointer."""
    shapes = ElementTree.fromstring(svg).iter(f"{SVG}{shape}")
    return [title.text or "" for each in shapes if (title := each.find(f"{SVG}title")) is not None]


@pytest.mark.slow
def test_the_page_fills_every_mark_and_shows_every_picture(record: list[Outcome]) -> None:
    text = page.text(record, real=record[:50])
    assert "<!--" not in text
    assert "| out_and_back | agents | 40 |" in text
    shown = set(re.findall(r"\(images/(\w+\.svg)\)", text))
    assert shown == set(page.pictures(record))
    assert text.index("## Where agents lose") < text.index("## Agents and baseline")


def test_real_ros_that_was_not_run_is_said_to_be_missing(record: list[Outcome]) -> None:
    assert page.agreement(record, []) == "This was not run."


def test_no_sentence_is_written_before_the_runs() -> None:
    """Whatever the runs give must not contradict the words around it: these have no number of theirs and no verdict."""
    words = (FOLDER / "page.md").read_text(encoding="utf-8")
    before_size = words[words.index("## Where agents lose") : words.index("## Size")]
    prose = re.sub(r"<!--.*?-->|!?\[.*?\]\(.*?\)", "", before_size)
    assert not re.search(r"\b(better|worse|more often|significant\w*|wins?|shown to)\b", prose)


@pytest.mark.slow
def test_the_front_page_has_the_worst_difference_first(record: list[Outcome]) -> None:
    rows = page.summary(record).split("\n\n")[0].splitlines()[2:]
    names = [row.split(" | ")[0].removeprefix("| ").replace(" ", "_") for row in rows]
    done = {each.scenario: each.pairs.difference for each in family(record) if each.what == DONE}
    assert names == sorted(SCENARIOS, key=lambda each: done[each])
    assert all(len(re.findall(r"\[[^]]+\]", row)) == 2 for row in rows)


def test_pictures_are_the_same_for_the_same_runs_and_read_aloud(record: list[Outcome]) -> None:
    for name, svg in page.pictures(record).items():
        assert svg == page.pictures(list(record))[name]
        root = ElementTree.fromstring(svg)
        assert root.attrib["role"] == "img"
        assert len(root.attrib["aria-label"]) > 40
        assert "prefers-color-scheme: dark" in svg


def test_differences_are_drawn_with_their_intervals_at_the_scale(record: list[Outcome]) -> None:
    found = family(record)
    svg = differences(found)
    assert titles(svg, "circle") == [f"{each.scenario}, {each.what}: {each.text}" for each in found]
    at = [float(each.attrib["cx"]) for each in ElementTree.fromstring(svg).iter(f"{SVG}circle")]
    lines = re.findall(r'<path class="(?:agents|baseline)" d="M([\d.]+) [\d.]+L([\d.]+) ', svg)
    units = [
        (float(high) - float(low)) / (each.interval.high - each.interval.low)
        for (low, high), each in zip(lines, found, strict=True)
    ]
    assert units == pytest.approx([units[0]] * len(units), rel=0.01)
    assert (at[1] - at[0]) / units[0] == pytest.approx(
        found[1].pairs.difference - found[0].pairs.difference, abs=0.002
    )


def test_each_kind_has_points_of_both_sides_that_hold_all_runs(record: list[Outcome]) -> None:
    svg = responses(record)
    points = [each for each in titles(svg, "circle") if " of " in each]
    of_side = [each for each in record if each.side in ("agents", "baseline")]
    assert sum(int(each.split(" ")[3]) for each in points) == len(of_side)
    words = [each.text for each in ElementTree.fromstring(svg).iter(f"{SVG}text")]
    assert {kind for kind in DOSES if kind in words} == set(DOSES)


def test_bars_have_the_shares_of_the_outcomes(record: list[Outcome]) -> None:
    svg = outcomes_by_side(record, ["agents"], ["square"])
    runs = [each for each in record if (each.scenario, each.side) == ("square", "agents")]
    assert titles(svg, "rect") == [f"{count(runs, end)} of 40 {end}" for end in ENDS if count(runs, end)]
    widths = [
        float(each.attrib["width"])
        for each in ElementTree.fromstring(svg).iter(f"{SVG}rect")
        if each.find(f"{SVG}title") is not None
    ]
    assert widths[0] / sum(widths) == pytest.approx(count(runs, DONE) / 40, abs=0.001)
