"""Forms for offered goals on the live page, in a real browser, and what became of the goals."""

from devtools import Page, chromium, needs_chromium

from jacaros import Mas, run
from jacaros.look import view

PROGRAM = """
{ offer(goal, deliver(parcel(string), room([kitchen, office])), doc("Bring a parcel to a room.")) }
{ offer(goal, light(on(boolean), level(number(0, 1)), colours(list), next(out(number)))) }
+!deliver(_, office) <- .refuse(closed(office)).
+!deliver(_, _) <- .progress(0.5, "on the way"); .wait(nothing).
+!light(On, Level, Colours, Level + 1) <- +lit(On, Level, Colours).
"""
GIVEN = "[...document.querySelectorAll('.given li')].map((each) => each.innerText)"


async def shown(page: Page, mas: Mas, address: str) -> None:
    """Open the page of an agent, and wait until it is shown."""
    mas.add_agent("bob", PROGRAM)
    await page.open(address)
    await page.wait_for("document.querySelector('.mind-head')")


@needs_chromium
def test_offered_goals_are_given_followed_and_cancelled() -> None:
    async def main() -> None:
        async with Mas(seed=1, world="none") as mas, view(mas, role="user") as address, chromium() as page:
            await shown(page, mas, address)
            await page.wait_for("document.querySelectorAll('.offered form').length === 2")
            # Checkboxes and scroll bars have the colours of the page, whatever the system prefers.
            await page.prefer("dark")
            assert await page.evaluate("getComputedStyle(document.documentElement).colorScheme") == "light"
            assert not await page.evaluate("document.querySelector('.console').checkVisibility()")
            await page.evaluate("document.querySelector('.offered input').focus()")
            await page.type("Ann, O'Hara")
            await page.press("Enter")
            await page.wait_for(f"{GIVEN}.some((each) => each.includes('on the way'))")
            assert await page.evaluate("document.querySelector('.given progress').value") == 0.5
            await page.click(".given .act")
            await page.wait_for(f"{GIVEN}[0].includes('cancelled')")
            await page.evaluate("document.querySelector('.offered select').value = 'office'")
            await page.click(".offered form button")
            await page.wait_for(f"{GIVEN}[0].includes('refused closed(office)')")
            await page.evaluate(
                """{ const [on, level, colours] = document.querySelectorAll(".offered form + form input");
                on.checked = true; level.value = "0.5"; colours.value = '[1, "red"]'; }"""
            )
            await page.click(".offered form + form button")
            await page.wait_for(f"{GIVEN}[0].includes('achieved next = 1.5')")
            assert mas.agent("bob").believes('lit(true, 0.5, [1, "red"])')
            assert page.errors == []

    run(main())


@needs_chromium
def test_the_page_of_an_observer_has_no_controls() -> None:
    async def main() -> None:
        async with Mas(seed=1) as mas, view(mas, role="observer") as address, chromium() as page:
            await shown(page, mas, address)
            controls = ".offered, .console, #controls, #tools"
            seen = f"[...document.querySelectorAll('{controls}')].filter((each) => each.checkVisibility()).length"
            assert await page.evaluate(seen) == 0
            await page.click("#tab-story")
            await page.wait_for("document.querySelectorAll('#story li').length > 0")
            assert page.errors == []

    run(main())
