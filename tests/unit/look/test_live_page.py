"""The live page in a real browser: it follows the run, changes its world, goes back in time, and survives its server."""

from devtools import browsed, browsing, chromium, needs_chromium

from jacaros import Mas
from jacaros.look import view

WORLD = """
name: lab
bounds: {from: [-3, -3], to: [3, 3]}
border: walls
doors: [{name: gate, segment: [[1, -3], [1, -2]], open: false}]
robots: [{name: turtlebot, pose: {x: -1, y: 0}}]
"""
PROGRAM = "!live. +!live <- .print(hello); .wait(100); .print(again); .wait(nothing)."
on_the_page = browsing(PROGRAM, ".robot", world=WORLD)
FORM = ".numbers:has([name=x])"


def pixel(x: float, y: float) -> str:
    """An expression for the pixel of a point of the world, which the map shows with its six metres as high as fits."""
    return f"""(() => {{
        const box = document.querySelector("#map canvas").getBoundingClientRect();
        const scale = Math.min((box.width - 52) / 6, (box.height - 70) / 6);
        return [box.x + box.width / 2 + {x} * scale, box.y + (box.height - 18) / 2 - {y} * scale];
    }})()"""


@on_the_page
async def test_a_robot_is_dragged(page) -> None:
    begin, end = await page.evaluate(pixel(-1, 0)), await page.evaluate(pixel(1, 2))
    await page.drag(*begin, *end)
    await page.wait_for("document.querySelector('.robot .where').textContent.startsWith('x 1.0')")
    robot = page.mas.world.robots["turtlebot"]
    assert abs(robot.x - 1.0) < 0.05
    assert abs(robot.y - 2.0) < 0.05
    await page.wait_for("document.querySelector('#log').innerText.includes('turtlebot moved')")


@on_the_page
async def test_the_story_appears_when_its_tab_is_opened_and_on_request(page) -> None:
    page.mas.agent("bob").post_goal("unknown")
    await page.wait_for("document.querySelector('#log').innerText.includes('!unknown')")
    assert await page.texts("#story li") == []
    await page.click("#tab-story")
    await page.wait_for("document.querySelectorAll('#story li.error').length === 1")
    assert "the run continues" in (await page.texts("#story li"))[-1]
    page.mas.agent("bob").post_goal("another")
    await page.wait_for("document.querySelector('#log').innerText.includes('!another')")
    await page.click("#story .plain")
    await page.wait_for("document.querySelectorAll('#story li.error').length === 2")


@on_the_page
async def test_doors_obstacles_and_batteries_change_by_keyboard(page) -> None:
    await page.evaluate("document.querySelector('[data-tool=\"door gate\"]').focus()")
    await page.press("Enter")
    await page.wait_for("document.activeElement.textContent === 'Close gate'")
    assert page.mas.world.doors["gate"]
    await page.evaluate("document.querySelector('[data-tool=obstacle]').focus()")
    await page.press("Enter")
    await page.wait_for(f"document.querySelector('{FORM} [name=x]')")
    await page.evaluate(f"document.querySelector('{FORM} [name=x]').select()")
    await page.type("2")
    await page.press("Enter")
    await page.wait_for("document.querySelector('#log').innerText.includes('obstacle 1 placed')")
    ((x, y, _),) = page.mas.world.obstacles.values()
    assert (x, y) == (2.0, 0.0)
    await page.evaluate("document.querySelector('.robot').focus()")
    await page.press("Enter")
    await page.wait_for("document.querySelector('[name=\"battery %\"]')")
    await page.evaluate("document.querySelector('[name=\"battery %\"]').select()")
    await page.type("33")
    await page.press("Enter")
    await page.wait_for("document.querySelector('.robot .level').textContent === '33 %'")


@on_the_page
async def test_a_rejected_change_gives_the_reason(page) -> None:
    await page.click("[data-tool=obstacle]")
    x, y = await page.evaluate(pixel(-1, 0))
    await page.click_at(x, y)
    await page.wait_for("document.querySelector('#tools [role=status]').innerText.length > 10")
    assert not page.mas.world.obstacles


@on_the_page
async def test_the_page_goes_back_in_time_and_back_to_live(page) -> None:
    await page.wait_for("document.querySelector('#log').innerText.includes('again')")
    assert await page.texts(".onair") == ["Live"]
    await page.press("Home")
    await page.wait_for("document.querySelector('#now').textContent === '0:00.0'")
    await page.wait_for("!document.querySelector('#log').innerText.includes('again')")
    assert not await page.evaluate("document.querySelector('#tools').checkVisibility()"), "the past is fixed"
    await page.click(".live")
    await page.wait_for("document.querySelector('#log').innerText.includes('again')")
    assert await page.texts(".onair") == ["Live"]


@needs_chromium
async def test_the_past_stays_available_after_the_run() -> None:
    async with chromium() as page:
        async with Mas(seed=1, world=WORLD, on_print=lambda *_: None) as mas, view(mas) as address:
            mas.add_agent("bob", "!live. +!live <- .print(hello).")
            await page.open(address)
            await page.wait_for("document.querySelector('#log').innerText.includes('hello')")
        await page.wait_for(
            "document.querySelector('#headline').innerText.includes('connection to the run lost')"
        )
        assert "hello" in await page.text("#log")


@on_the_page
async def test_a_page_open_for_days_drops_old_records(page) -> None:
    kept = await page.evaluate(
        """Promise.all(["run", "world", "log"].map((name) => import(`./${name}.js`))).then(([r, w, l]) => {
            const world = new w.World(), log = new l.Log(), run = new r.Run([world, log]);
            const row = [0, 0, 0, 50, 0, 0], robots = Array(100).fill(row);
            run.add({ kind: "world", world: { bounds: [-1, -1, 1, 1] } });
            for (let n = 0; n < 30000; n++) run.take({ kind: "frame", t: n / 10, robots });
            for (let n = 0; n < 150000; n++) run.take({ kind: "text", t: n, agent: "a", text: "x" });
            const state = world.state(99, 2999.9);
            const lines = [log.entries.values.length, log.entries.times.length];
            return [world.times.length, world.columns[0].x.length, ...lines, state.battery];
        })"""
    )
    frames, rows, lines, times, battery = kept
    assert frames == rows <= 20_000
    assert lines == times <= 100_000
    assert battery == 50


@on_the_page
async def test_the_page_remembers_tab_and_theme(page) -> None:
    await page.click("#theme")
    await page.click("#tab-program")
    theme = await page.evaluate("document.documentElement.dataset.theme")
    await page.open(await page.evaluate("location.href"))
    await page.wait_for("document.querySelector('#program').checkVisibility()")
    assert await page.evaluate("document.documentElement.dataset.theme") == theme


@on_the_page
async def test_a_world_of_any_size_is_drawn(page) -> None:
    for size in (0.01, 1e4, 1e12):
        await page.evaluate(
            f"""import("./world.js").then(async (w) => {{
                const {{ FloorDrawing }} = await import("./floor_drawing.js");
                const {{ Projection }} = await import("./projection.js");
                const world = new w.World();
                world.add(0, "world", {{ bounds: [-{size}, -{size}, {size}, {size}] }});
                world.add(0, "obstacle_placed", {{ obstacle: "rock", x: 0, y: 0, radius: {size} }});
                const drawing = new FloorDrawing(), projection = new Projection(world.bounds, 800, 600);
                drawing.draw(world.drawing(0), projection, 1, {{ width: 800, height: 600 }}, world);
                const {{ drawObstacles }} = await import("./thing_drawing.js");
                drawObstacles(drawing.pen, projection, world, 0);
            }})"""
        )


@needs_chromium
async def test_a_world_created_late_can_be_changed() -> None:
    async with browsed("!live. +!live <- .wait(nothing).", ".intention") as page:
        await page.wait_for("document.querySelector('#agents').innerText.includes('!live')")
        assert not await page.evaluate("document.querySelector('#stage').checkVisibility()")
        assert page.mas.world is not None  # it comes into being when it is first asked for
        await page.wait_for("document.querySelector('[data-tool=obstacle]')?.checkVisibility()")
        assert await page.texts(".robot .name") == ["turtlebot"]
