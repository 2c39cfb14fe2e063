"""The replay page and the still picture: self-contained, complete, and shown by a real browser."""

import base64
import gzip
import itertools
import json
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import msgspec
import pytest
from devtools import needs_chromium, replayed

from jacaros.look.page.page import STATIC, bundle, lines_of, replay_html
from jacaros.look.page.picture import picture_svg, write_picture
from jacaros.look.page.recorder import Recorder
from jacaros.look.page.scene import RobotView
from jacaros.look.records.recording import Recording
from jacaros.robots.world import World
from jacaros.robots.world.data.ground_truth import RobotState
from jacaros.runtime.errors import JacarosError


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
                for index, robot in enumerate(drawing["robots"])
            ],
        )
    recorder.text(1.0, "cleaner", "</script><b>mop & vacuum</b>")
    recorder.event(0.5, "goal", {"agent": "cleaner", "goal": "clean(kitchen)", "state": "pursued"})
    recorder.event(2.0, "docked", {"robot": "turtlebot", "dock": "dock"})
    recorder.close()
    return recorder.recording


def unpacked(page: str) -> list[dict[str, Any]]:
    found = re.search(r'<script type="text/plain" id="recording">([^<]*)</script>', page)
    assert found is not None
    return [json.loads(line) for line in gzip.decompress(base64.b64decode(found.group(1))).splitlines()]


def test_the_page_holds_all_records_in_time_order() -> None:
    run = recording()
    columns, *held, story = unpacked(replay_html(run))
    assert story["lines"][0]["text"] == "cleaner: pursued `clean(kitchen)`"
    assert held == msgspec.to_builtins(list(lines_of(run)))
    assert held[0]["world"]["name"] == "house"
    assert list(itertools.accumulate(columns["t"])) == [round(frame.t * 1000) for frame in run.frames]
    (robot,) = columns["robots"]
    xs = [round(frame.robots[0].x * 1000) for frame in run.frames]
    assert list(itertools.accumulate(robot["x"])) == xs
    assert sum(robot["charging"]) == 1, "charging at the end"
    assert sum(robot["touching"]) == 0
    assert tuple(columns["scales"]) == tuple(robot) == RobotState._fields
    (text,) = (record for record in held if record["kind"] == "text")
    assert (text["agent"], text["text"]) == ("cleaner", "</script><b>mop & vacuum</b>")
    times = [record.get("t", 0.0) for record in held]
    assert times == sorted(times)


def test_the_page_loads_nothing() -> None:
    page = replay_html(recording())
    without_data = re.sub(r'id="recording">[^<]*<', 'id="recording"><', page)
    assert not re.search(
        r"https?:|//\w+\.\w|@import|\bsrc=|\bhref=(?!.data:)|url\(|\bfetch\(|XMLHttp", without_data
    )
    assert "default-src 'none'" in page
    assert "unsafe-inline" not in page


def test_a_page_is_named_after_the_project() -> None:
    run = recording()
    run.events.append((0.0, "run", {"name": "cleaners"}))
    assert "<title>cleaners</title>" in replay_html(run)
    assert "<title>house</title>" in replay_html(recording())


def test_the_same_recording_gives_the_same_page() -> None:
    assert replay_html(recording()) == replay_html(recording())


def test_a_recording_without_frames_still_makes_a_page() -> None:
    recorder = Recorder()
    recorder.world(World.load("empty").description.drawing())
    assert [record["kind"] for record in unpacked(replay_html(recorder.recording))] == [
        "frames",
        "world",
        "story",
    ]


def test_modules_are_joined_in_the_order_of_their_imports(tmp_path: Path) -> None:
    (tmp_path / "first.js").write_text('import {\n  two,\n} from "./second.js";\nconst end = two;\n')
    (tmp_path / "second.js").write_text("export const two = 2;\nexport async function three() {}\n")
    joined = bundle(tmp_path, "first")
    assert joined.index("const module_second = (() =>") < joined.index("const module_first = (async () =>")
    assert "return { two, three };" in joined
    assert "} = module_second;" in joined


@pytest.mark.parametrize(
    ("source", "reason"),
    [
        ("export default 3;", "another form: export default 3;"),
        ('import x from "./other.js";', "another form: import x"),
        ('import { x } from "./entry.js";', "import each other: entry -> entry"),
    ],
)
def test_unsupported_modules_are_rejected(tmp_path: Path, source: str, reason: str) -> None:
    (tmp_path / "entry.js").write_text(source)
    with pytest.raises(JacarosError, match=reason):
        bundle(tmp_path, "entry")


def test_no_module_ends_the_script_that_it_is_part_of() -> None:
    for module in STATIC.glob("*.js"):
        assert "</script" not in module.read_text(encoding="utf-8").lower(), module.name


@needs_chromium
@pytest.mark.parametrize("world", ["house", "two_robots"])
async def test_a_browser_shows_the_run_at_a_moment(world: str) -> None:
    async with replayed(recording(world), more="&theme=dark") as page:
        assert await page.evaluate("document.documentElement.dataset.theme") == "dark"
        assert "70 %" in await page.text("#robots"), "the battery"
        assert "clean(kitchen)" in await page.text("#agents")
        log = await page.text("#log")
        assert "</script><b>mop & vacuum</b>" in log
        assert "docked at dock" in log
        assert await page.evaluate("document.querySelector('#notice').hidden")


@needs_chromium
async def test_the_map_is_drawn_and_a_click_selects_a_robot() -> None:
    async with replayed(recording()) as page:
        colours = """new Set(new Uint32Array(document.querySelector("#map canvas").getContext("2d")
            .getImageData(0, 0, 800, 600).data.buffer)).size"""
        assert await page.evaluate(colours) > 10
        await page.click(".robot")
        await page.wait_for("document.querySelector('.robot').getAttribute('aria-pressed') === 'true'")


@needs_chromium
async def test_keys_move_through_time() -> None:
    async with replayed(recording()) as page:
        for key, now in (
            ("ArrowRight", "0:04.0"),
            ("ArrowLeft", "0:03.0"),
            ("End", "0:04.9"),
            ("Home", "0:00.0"),
        ):
            await page.press(key)
            await page.wait_for(f"document.querySelector('#now').textContent === '{now}'")
        await page.press(" ")
        await page.wait_for(
            "document.querySelector('#play').getAttribute('aria-label') === 'Pause the replay'"
        )
        await page.wait_for("document.querySelector('#play').getAttribute('aria-label') === 'Play'")
        assert await page.text("#now") == "0:04.9", "it stops at the end"


@needs_chromium
async def test_marks_are_reachable_by_keyboard_and_have_texts() -> None:
    run = recording()
    run.events.append((4.0, "bump", {"robot": "turtlebot", "side": "front"}))
    async with replayed(run) as page:
        await page.wait_for("document.querySelectorAll('.marks .mark').length === 2")
        await page.evaluate("document.querySelector('.marks .mark').focus()")
        assert await page.text("#timeline .tip") == "0:02.0 docked: docked at dock"
        await page.press("ArrowRight")
        assert (await page.text("#timeline .tip")).startswith("0:04.0 failure: bumped into a wall")
        label = "document.activeElement.getAttribute('aria-label')"
        assert (await page.evaluate(label)).startswith("0:04.0 failure: bumped into a wall")
        await page.press("Enter")
        await page.wait_for("document.querySelector('#now').textContent === '0:04.0'")


@needs_chromium
async def test_a_run_without_robots_has_no_map() -> None:
    recorder = Recorder()
    recorder.event(1.0, "goal", {"agent": "a", "goal": "!greet", "state": "pursued", "id": 1, "intention": 1})
    recorder.text(3.0, "a", "hello")
    recorder.close()
    async with replayed(recorder.recording) as page:
        assert not await page.evaluate("document.querySelector('#map').checkVisibility()")
        assert "!greet" in await page.text("#agents")


@needs_chromium
async def test_the_reason_of_nested_goals_is_shown_once() -> None:
    recorder = Recorder()
    why = "action_failed, no way (robot.asl:4)\nstep: navigate_to(5,5,0)"
    goals = (("!work", why), ("!tour", why), ("!other", "stuck (robot.asl:9)"))
    for number, (goal, _) in enumerate(goals):
        recorder.event(0.1 * number, "goal", {"agent": "a", "goal": goal, "state": "pursued", "id": number})
    for number, (goal, reason) in enumerate(goals):
        failed = {"agent": "a", "goal": goal, "state": "failed", "id": number, "why": reason}
        recorder.event(2.0, "goal", failed)
    recorder.close()
    async with replayed(recorder.recording, 2.0) as page:
        found = await page.evaluate(
            "[...document.querySelectorAll('#agents li.failed')].map((each) => "
            "[each.querySelector('code').textContent, each.querySelector('.why')?.innerText ?? ''])"
        )
        assert found == [
            ["!work", ""],
            ["!tour", "action_failed, no way (robot.asl:4)"],
            ["!other", "stuck (robot.asl:9)"],
        ]


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


def test_a_world_with_any_name_is_shown() -> None:
    made = recording()
    made.world["name"] = '<link rel="stylesheet" href="page.css"></title><script>alert(1)</script>'
    page = replay_html(made)
    assert "<title>&lt;link rel=" in page
    assert "<script>alert" not in page
    assert unpacked(page)[1]["world"]["name"] == made.world["name"]


@needs_chromium
async def test_the_valid_parts_of_broken_records_are_shown() -> None:
    recorder = Recorder()
    recorder.event(1.0, "goal", {"agent": "a", "goal": "!go", "state": "failed", "why": 5})
    recorder.text(3.0, "a", "hello")
    async with replayed(recorder.recording) as page:
        assert "hello" in await page.text("#log")
        assert (await page.text("#notice")).startswith("1 record is not shown: goal: ")


@needs_chromium
@pytest.mark.parametrize(("width", "height"), [(1400, 900), (900, 800), (390, 844)])
async def test_the_page_fits_its_window(width: int, height: int) -> None:
    async with replayed(recording("two_robots")) as page:
        await page.resize(width, height, mobile=width < 500)
        await page.wait_for(f"innerWidth === {width}")
        await page.wait_for("document.querySelector('#map canvas').width > 100")
        assert await page.evaluate("document.documentElement.scrollWidth") <= width
        play = await page.evaluate("document.querySelector('#play').getBoundingClientRect().bottom")
        assert play <= height, "the controls are seen without scrolling"


@needs_chromium
async def test_every_button_is_reachable_by_the_tab_key() -> None:
    async with replayed(recording("two_robots")) as page:
        reached = set()
        for _ in range(30):
            await page.press("Tab")
            reached.add(
                await page.evaluate(
                    "(document.activeElement.closest('[id]') ?? document.body).id + ' ' + document.activeElement.className"
                )
            )
        places = {each.split()[0] for each in reached if each.strip()}
        assert places >= {"theme", "map", "robots", "tab-agents", "agents", "log", "play", "scrub", "speed"}
        unnamed = await page.evaluate(
            "[...document.querySelectorAll('button, input, select')].filter((each) => each.checkVisibility()"
            " && !each.innerText && !each.ariaLabel && !each.labels?.length).map((each) => each.outerHTML)"
        )
        assert unnamed == []
