"""The replay page and the still picture: self-contained, complete, and shown by a real browser."""

import base64
import gzip
import itertools
import json
import re
import shutil
import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import pytest

from jacaros.inspector.picture import picture_svg, write_picture
from jacaros.inspector.recorder import Recorder
from jacaros.inspector.recording import Recording
from jacaros.inspector.replay import replay_html, write_replay
from jacaros.inspector.scene import RobotView
from jacaros.sim import World

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


def recording(world: str = "house") -> Recording:
    recorder = Recorder()
    drawing = World.load(world).description.drawing()
    recorder.world(drawing)
    for step in range(50):
        recorder.frame(
            step * 0.1,
            [
                RobotView(
                    robot["name"], 0.04 * step - index, 0.5 * index, 0.1 * step, 100.0 - step, step > 40
                )
                for index, robot in enumerate(drawing["robots"])  # type: ignore[arg-type, var-annotated]
            ],
        )
    recorder.text(1.0, "cleaner", "</script><b>mop & vacuum</b>")
    recorder.event(0.5, "goal", {"agent": "cleaner", "goal": "clean(kitchen)", "state": "pursued"})
    recorder.event(2.0, "docked", {"robot": "turtlebot", "dock": "dock"})
    recorder.close()
    return recorder.recording


def unpacked(page: str) -> dict[str, Any]:
    found = re.search(r'<script type="text/plain" id="recording">([^<]*)</script>', page)
    assert found is not None
    data: dict[str, Any] = json.loads(gzip.decompress(base64.b64decode(found.group(1))))
    return data


def test_the_page_holds_all_frames_prints_and_events() -> None:
    run = recording()
    data = unpacked(replay_html(run))
    times = list(itertools.accumulate(data["t"]))
    xs = list(itertools.accumulate(data["robots"][0]["x"]))
    assert times == [round(frame.t * 1000) for frame in run.frames]
    assert xs == [round(frame.robots[0][0] * 1000) for frame in run.frames]
    assert data["robots"][0]["flags"][-1] == 1, "charging at the end"
    assert data["texts"] == [[1.0, "cleaner", "</script><b>mop & vacuum</b>"]]
    assert len(data["events"]) == 2
    assert data["world"]["name"] == "house"


def test_the_page_needs_nothing_from_anywhere() -> None:
    page = replay_html(recording(), title="A <b>run</b>")
    without_data = re.sub(r'id="recording">[^<]*<', 'id="recording"><', page)
    assert not re.search(r"https?:|//\w+\.\w|@import|\bsrc=|\bhref=|url\(|\bfetch\(|XMLHttp", without_data)
    assert "default-src 'none'" in page
    assert "<title>A &lt;b&gt;run&lt;/b&gt;</title>" in page
    assert "{{" not in without_data


def test_the_same_recording_gives_the_same_page() -> None:
    assert replay_html(recording()) == replay_html(recording())


def test_a_recording_without_frames_still_makes_a_page() -> None:
    recorder = Recorder()
    recorder.world(World.load("empty").description.drawing())
    assert unpacked(replay_html(recorder.recording))["robots"] == []


def dom(page: Path, fragment: str) -> str:
    """The document that a browser makes of a page."""
    assert CHROMIUM is not None
    return subprocess.run(
        [
            CHROMIUM,
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--dump-dom",
            "--virtual-time-budget=5000",
            f"{page.as_uri()}#{fragment}",
        ],
        check=True,
        capture_output=True,
        text=True,
        timeout=120,
    ).stdout


@pytest.mark.browser
@pytest.mark.slow
@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")
@pytest.mark.parametrize("world", ["house", "two_robots"])
def test_a_browser_shows_the_run_at_a_moment(tmp_path: Path, world: str) -> None:
    page = tmp_path / "replay.html"
    write_replay(recording(world), page)
    shown = dom(page, "t=3&theme=dark")
    assert re.search(r'id="now">0:03\.0<', shown)
    assert 'id="fault" hidden' in shown
    assert 'data-theme="dark"' in shown
    assert "70 %" in shown, "the battery"
    assert "clean(kitchen)" in shown
    assert "&lt;b&gt;mop &amp; vacuum" in shown
    assert "docked at dock" in shown


def test_the_picture_is_svg_with_path_dock_and_rooms() -> None:
    root = ElementTree.fromstring(picture_svg(recording()))
    name = "{http://www.w3.org/2000/svg}"
    assert len(root.findall(f".//{name}polyline")) > 20
    assert [text.text for text in root.findall(f".//{name}text")] == [
        "hallway",
        "living room",
        "kitchen",
        "bathroom",
    ]
    assert len(root.findall(f".//{name}circle[@class='dock']")) == 2
    assert len(root.findall(f".//{name}rect[@class='area']")) == 4


def test_the_picture_of_two_robots_names_them(tmp_path: Path) -> None:
    write_picture(recording("two_robots"), tmp_path / "run.svg")
    text = (tmp_path / "run.svg").read_text()
    assert ">robot_0<" in text
    assert ">robot_1<" in text
    colours = re.findall(r'class="heading"[^>]*style="fill:(#\w+)"', text)
    assert len(set(colours)) == 2
    assert all(f'stroke="{colour}"' in text for colour in colours), "a robot has the colour of its path"
    assert "http" not in text.replace("http://www.w3.org/2000/svg", "")


@pytest.mark.browser
@pytest.mark.slow
@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")
def test_of_goals_that_a_plan_pursues_again_and_again_the_newest_are_shown(tmp_path: Path) -> None:
    recorder = Recorder()
    for number, goal in enumerate(["!start", *(f'!round("a,b", {n})' for n in range(9)), "!round(9)"]):
        recorder.event(number * 0.1, "goal", {"agent": "a", "goal": goal, "state": "pursued", "id": number})
    recorder.event(0.95, "goal", {"agent": "a", "goal": '!round("a,b", 8)', "state": "suspended", "id": 9})
    recorder.close()
    page = tmp_path / "replay.html"
    write_replay(recorder.recording, page)
    shown = dom(page, "t=2")
    found = re.findall(
        r'<li class="(?:pursued|suspended)"><i></i><span>(.*?)</span><span class="state">', shown
    )
    goals = [re.sub("<[^>]*>", "", each).replace("&quot;", '"') for each in found]
    assert goals == ["!round(9)", '!round("a,b", 8)', '!round("a,b", 7)  and 7 before it', "!start"]


@pytest.mark.browser
@pytest.mark.slow
@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")
def test_each_intention_has_a_card_that_begins_with_what_is_done_now(tmp_path: Path) -> None:
    recorder = Recorder()
    for number, (goal, intention) in enumerate((("!tour", 1), ("!watch", 2), ("!go", 1), ("!turn", 1))):
        told = {"agent": "a", "goal": goal, "state": "pursued", "id": number, "intention": intention}
        recorder.event(number * 0.1, "goal", told)
    recorder.event(0.5, "goal", {**told, "state": "achieved"})
    recorder.close()
    page = tmp_path / "replay.html"
    write_replay(recorder.recording, page)
    cards = re.findall(r'<ul class="intention">(.*?)</ul>', dom(page, "t=2"))
    assert [re.findall(r"<span>(.*?)</span>", card) for card in cards] == [["!go", "!tour"], ["!watch"]]


@pytest.mark.browser
@pytest.mark.slow
@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")
def test_the_reason_of_goals_that_were_for_one_another_is_shown_once(tmp_path: Path) -> None:
    recorder = Recorder()
    why = "action_failed, no way (robot.asl:4)\nstep: navigate_to(5,5,0)"
    goals = (("!work", why), ("!tour", why), ("!other", "stuck (robot.asl:9)"))
    for number, (goal, _) in enumerate(goals):
        recorder.event(0.1 * number, "goal", {"agent": "a", "goal": goal, "state": "pursued", "id": number})
    for number, (goal, reason) in enumerate(goals):
        told = {"agent": "a", "goal": goal, "state": "failed", "id": number, "why": reason}
        recorder.event(1.0, "goal", told)
    recorder.close()
    page = tmp_path / "replay.html"
    write_replay(recorder.recording, page)
    found = re.findall(
        r'<li class="failed past"><i></i><span>(.*?)</span>.*?</span>(?:<span class="why"[^>]*>(.*?)</span>)?</li>',
        dom(page, "t=2"),
    )
    assert found == [
        ("!work", ""),
        ("!tour", "action_failed, no way (robot.asl:4)"),
        ("!other", "stuck (robot.asl:9)"),
    ]


def test_a_world_may_have_any_name() -> None:
    made = recording()
    made.world["name"] = "{{RECORDING}}</title><script>alert(1)</script>"
    page = replay_html(made)
    assert "<title>{{RECORDING}}&lt;/title&gt;&lt;script&gt;alert(1)" in page
    assert unpacked(page)["world"]["name"] == made.world["name"]
