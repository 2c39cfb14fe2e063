"""The page's views of minds, programs, artifacts, messages and causes, in a real browser."""

import sys
from contextlib import AbstractAsyncContextManager
from pathlib import Path
from typing import Any

from devtools import Page, needs_chromium, replayed

from jacaros.look.page.recorder import Recorder

sys.path.insert(0, str(Path(__file__).parents[1] / "runtime" / "mas" / "history"))
from guard_story import RECORDS, Record


def shown(records: list[Record], at: float = 12.0) -> AbstractAsyncContextManager[Page]:
    recorder = Recorder()
    for each in records:
        recorder.event(*each)
    recorder.close()
    return replayed(recorder.recording, at)


def goal(t: float, number: int, text: str, state: str = "pursued", **more: Any) -> Record:
    return t, "goal", {"agent": "a", "goal": text, "state": state, "id": number, **more}


async def unfold(page: Page, title: str) -> None:
    find = f"[...document.querySelectorAll('.section')].find((each) => each.innerText.startsWith('{title}'))"
    await page.evaluate(f"{find}.open = true")
    await page.wait_for(f"{find}.querySelector('.picture').children.length")


@needs_chromium
async def test_a_card_begins_with_the_current_step_and_unfolds_its_stack() -> None:
    stack = [
        {"goal": "!patrol", "plan": 1, "file": "guard.asl", "line": 6, "step": "!go(kitchen)"},
        {"goal": "!go(kitchen)", "plan": 5, "file": "guard.asl", "line": 12, "step": ".wait(500)"},
    ]
    intention = {"agent": "guard", "id": 7, "state": "waits", "stack": stack, "waits": "0.5 s", "since": 11.5}
    record = 12.0, "intention", {**intention, "reason": "", "urgency": 3, "cause": 22}
    async with shown([*RECORDS, record]) as page:
        (card,) = await page.texts(".intention[aria-label^='Intention 7']")
        lines = card.splitlines()
        assert lines[0] == ".wait(500)"
        assert "guard.asl:12" in card
        assert "since 0:11.5 · 0.5 s" in card
        assert "waits for 0.5 s" in card
        assert "!patrol › !go(kitchen)" in card
        assert "urgency 3" in card
        assert "guard.asl:6" not in card
        await page.click(".intention[aria-label^='Intention 7'] summary")
        await page.wait_for("document.querySelector('.stack[open]')")
        assert "guard.asl:6" in (await page.texts(".stack[open] ol"))[0]


@needs_chromium
async def test_agents_that_only_report_goals_have_a_card_for_each_intention() -> None:
    goals = [
        goal(0.1 * n, n, text, intention=number)
        for n, (text, number) in enumerate((("!tour", 1), ("!watch", 2), ("!go", 1), ("!turn", 1)))
    ]
    async with shown([*goals, goal(2.0, 3, "!turn", "achieved", intention=1)], 2.0) as page:
        assert await page.texts(".intention .step") == ["!go", "!watch"]
        assert await page.texts(".intention .stack summary") == ["!tour › !go"]


@needs_chromium
async def test_a_deep_stack_shows_its_ends() -> None:
    goals = [goal(0.1 * n, n, f"!round({n})", intention=1) for n in range(12)]
    async with shown(goals, 1.1) as page:
        assert await page.texts(".intention .stack summary") == [
            "!round(0) › 9 more › !round(10) › !round(11)"
        ]


@needs_chromium
async def test_a_click_shows_the_causes_back_to_the_sensor() -> None:
    async with shown(RECORDS) as page:
        await page.click("#tab-causes")
        await page.click(".link[data-kind='command']")
        await page.wait_for("document.querySelector('.asked').innerText === 'wheel command: stand still'")
        assert await page.texts(".chain .words") == [
            "operation stop/0 of wheels",
            "plan step stop/0 of @low",
            "event +battery(12), handled by @low",
            "property battery(12)",
            "message on /battery",
        ]
        await page.evaluate("[...document.querySelectorAll('.chain .link')].at(-1).focus()")
        await page.press("Enter")
        await page.wait_for("document.querySelector('.asked').innerText === 'message on /battery'")
        effects = await page.texts(".effects .words")
        assert effects[:2] == ["property battery(12)", "event +battery(12), handled by @low"]
        assert effects[-1] == "wheel command: stand still, and 1 more until 0:09.2"


@needs_chromium
async def test_a_decision_explains_why_each_plan_was_selected_or_not() -> None:
    async with shown(RECORDS) as page:
        await unfold(page, "Plans")
        plans = await page.texts(".plan > summary")
        assert plans[1].split("\n")[-1].split() == ["✓", "1", "✗", "1"]
        assert "never ran" in plans[3]
        await page.evaluate("document.querySelectorAll('.plan')[1].open = true")
        await page.wait_for("document.querySelector('.reasons')?.checkVisibility()")
        assert "1× refused: stops at `B < L` with B=40, L=20" in await page.text(".reasons")
        await page.click(".reasons .jump[data-key$='why']")
        await page.wait_for("document.querySelector('.candidates')?.checkVisibility()")
        assert [each.split()[:2] for each in await page.texts(".candidates li")] == [
            ["✗", "@low"],
            ["✓", "+battery(B)"],
        ]


@needs_chromium
async def test_going_back_in_time_shows_earlier_beliefs_and_the_filter_works() -> None:
    async with shown(RECORDS) as page:
        assert await page.texts(".beliefs code") == ["battery(100)", "battery(12)"]
        for _ in range(4):
            await page.press("ArrowLeft")
        await page.wait_for("document.querySelector('#now').textContent === '0:08.0'")
        await page.wait_for("!document.querySelector('.beliefs').innerText.includes('battery(12)')")
        assert await page.texts(".beliefs code") == ["battery(100)", "battery(40)"]
        await page.press("ArrowRight")
        await page.wait_for("document.querySelector('.beliefs .recent code')?.innerText === 'battery(12)'")
        assert await page.texts(".beliefs .recent .was") == ["battery(40)"]


@needs_chromium
async def test_beliefs_are_filtered() -> None:
    many = [(0.0, "belief", {"agent": "guard", "op": "+", "belief": f"door({n})"}) for n in range(8)]
    async with shown([*RECORDS, *many]) as page:
        assert len(await page.texts(".beliefs code")) == 10
        await page.click("input[aria-label='Filter beliefs']")
        await page.type("door(3")
        await page.wait_for("document.querySelectorAll('.beliefs code').length === 1")
        assert await page.texts(".beliefs code") == ["door(3)"]


@needs_chromium
async def test_the_program_marks_current_lines_and_plans_that_never_ran() -> None:
    async with shown(RECORDS) as page:
        await page.click("#tab-program")
        await page.wait_for("document.querySelector('.code-line.current')")
        current = await page.texts(".code-line.current")
        assert [line.split()[0] for line in current] == ["12"]
        numbers = (
            "[...document.querySelectorAll('.code-line.{}')].map((each) => each.innerText.split(/\\s/)[0])"
        )
        assert await page.evaluate(numbers.format("unused")) == ["10", "11", "12", "13"]
        assert await page.evaluate(numbers.format("used")) == ["5", "6", "7", "8", "9"]


@needs_chromium
async def test_a_thousand_agents_are_listed_without_lag() -> None:
    agents = [(0.0, "agent", {"agent": f"agent{n}", "what": "asl", "state": "began"}) for n in range(1000)]
    async with shown([*RECORDS, *agents]) as page:
        assert len(await page.texts(".item")) < 40
        await page.click("input[aria-label='Find agents by name']")
        await page.type("agent99")
        await page.wait_for("document.querySelector('.item b').innerText.startsWith('agent99')")
        await page.press("ArrowDown")
        await page.press("End")
        await page.wait_for("document.querySelector('.mind-head h2').innerText === 'agent999'")
        slowest = await page.evaluate(
            "new Promise((done) => { const times = []; let last = performance.now(); const tick = (now) => {"
            "times.push(now - last); last = now; if (times.length > 30) done(times.slice(1).sort((a, b) => a - b)[15]);"
            "else { document.querySelector('#scrub').dispatchEvent(new Event('input')); requestAnimationFrame(tick); } };"
            "requestAnimationFrame(tick); })"
        )
        assert slowest < 100, "milliseconds from one picture to the next"


@needs_chromium
async def test_messages_are_a_list_that_leads_to_their_causes() -> None:
    sent = {"id": 90, "from": "guard", "to": "cook", "performative": "tell", "content": "low(12)"}
    async with shown([*RECORDS, (11.0, "message", {**sent, "state": "sent"})]) as page:
        await page.click("#tab-messages")
        await page.wait_for("document.querySelector('.message')")
        assert await page.texts(".message .said") == ["tell low(12)"]
        label = "document.querySelector('.message').getAttribute('aria-label')"
        assert await page.evaluate(label) == "0:11.0 guard to cook: tell low(12), not read yet"
        await page.click(".message")
        await page.wait_for(
            "document.querySelector('.asked')?.innerText === 'message from guard to cook: tell low(12)'"
        )


@needs_chromium
async def test_artifacts_have_properties_operations_and_observers() -> None:
    wheels = {"artifact": "/main/wheels"}
    more: list[Record] = [
        (0.2, "focus", {**wheels, "agent": "guard", "on": True}),
        (8.0, "property", {**wheels, "name": "speed", "values": [0.25], "cause": 4}),
    ]
    async with shown(sorted([*RECORDS, *more], key=lambda record: record[0])) as page:
        await page.click("#tab-artifacts")
        await page.wait_for("document.querySelector('#artifacts .beliefs')?.checkVisibility()")
        text = await page.text("#artifacts")
        assert "speed(0.25)" in text
        assert "go(kitchen)" in text
        assert await page.texts("#artifacts .names button") == ["guard"]
