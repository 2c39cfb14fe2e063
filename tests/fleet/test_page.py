"""The members of a fleet in the records of a run, and on its page."""

import asyncio
import sys
from collections.abc import Awaitable, Callable
from contextlib import AsyncExitStack
from pathlib import Path
from typing import Any

import pytest
from systems import Fleet, fleet

import jacaros
from jacaros import Mas
from jacaros.look import Recording, view
from jacaros.look.page.recorder import Recorder
from jacaros.look.page.watch import watch_of
from jacaros.look.records.lasting import Lasting

sys.path.insert(0, str(Path(__file__).parent.parent / "unit" / "look"))
from devtools import Page, chromium, needs_chromium


def run(scene: Callable[[Fleet], Awaitable[None]], *names: str, clock: Any = "fast") -> None:
    """Play a scene with a fleet."""

    async def main() -> None:
        async with fleet(*names) as systems:
            await scene(systems)

    jacaros.run(main(), clock=clock)


def members(mas: Mas) -> list[tuple[str, str, list[str]]]:
    """Return the recorded changes: member, state and agents."""
    found = [each.data for each in mas.system.history().events if each.event == "member"]
    return [(data["member"], data["state"], data.get("agents", [])) for data in found]


def test_a_recording_notes_members_that_come_and_go(tmp_path: Path) -> None:
    async def scene(systems: Fleet) -> None:
        hall, lab = systems["hall"], systems["lab"]
        watch = watch_of(hall.system, [Recorder(tmp_path / "run.jsonl")])
        watch.start()
        lab.add_agent("ann", "")
        await hall.sleep(1.5)
        systems.network.cut("hall", "lab")
        await hall.sleep(3)
        systems.network.heal("hall", "lab")
        await hall.sleep(1.5)
        async with AsyncExitStack() as stack:
            await systems.join(stack, "yard")
            await hall.sleep(1.5)
        await hall.sleep(1.5)
        watch.stop()
        for each in watch.watchers:
            each.close()  # type: ignore[attr-defined]

    run(scene, "hall", "lab")
    events = [each for each in Recording.read(tmp_path / "run.jsonl").events if each[1] == "member"]
    told = [(data["member"], data["state"]) for _, _, data in events]
    # The same state again: its agents have changed.
    assert [each for n, each in enumerate(told) if each not in told[n - 1 : n]] == [
        ("hall", "self"),
        ("lab", "joined"),
        ("lab", "lost"),
        ("lab", "joined"),
        ("yard", "joined"),
        ("yard", "left"),
    ]
    lasting: Lasting[str] = Lasting()
    for _, kind, data in events:
        lasting.take(kind, data, data["member"])
    assert sorted(lasting) == ["hall", "lab"]


def test_records_of_a_member_follow_its_agents_and_do_not_repeat() -> None:
    async def scene(systems: Fleet) -> None:
        hall, lab = systems["hall"], systems["lab"]
        hall.system.keep_history()
        await hall.sleep(10)
        assert members(hall) == [("hall", "self", []), ("lab", "joined", [])]
        ann = lab.add_agent("ann", "")
        await hall.sleep(2)
        assert members(hall)[2:] == [("lab", "joined", ["ann"])]
        ann.kill()
        await hall.sleep(2)
        assert members(hall)[3:] == [("lab", "joined", [])]
        newest = [each.data for each in hall.system.history().events if each.event == "member"][-1]
        assert newest["delay"] == pytest.approx(0.002, rel=0.1)

    run(scene, "hall", "lab")


def test_the_address_of_a_page_reaches_others_and_its_token_does_not() -> None:
    async def scene(systems: Fleet) -> None:
        hall, lab = systems["hall"], systems["lab"]
        sent: list[bytes] = []
        carry = systems.network.carry
        systems.network.carry = lambda *to: (sent.append(to[2]), carry(*to))  # type: ignore[method-assign,func-returns-value]
        hall.system.keep_history()

        def page_of_lab() -> str:
            return next(each.page for each in systems.members["hall"].members() if each.member == "lab")

        async with view(lab) as address:
            await asyncio.sleep(0.5)
            shown, token = page_of_lab(), address.rstrip("/").rpartition("/")[2]
            assert address == f"{shown}{token}/"
            assert any(shown.encode() in each for each in sent)
            assert not any(token.encode() in each for each in sent)
        await asyncio.sleep(0.5)
        assert page_of_lab() == ""

    run(scene, "hall", "lab", clock="real")


async def _cards(page: Page) -> list[str]:
    return [text.replace("\n", " ") for text in await page.texts(".member")]


@needs_chromium
def test_the_page_shows_all_systems_and_follows_them() -> None:
    async def scene(systems: Fleet) -> None:
        hall, kitchen = systems["hall"], systems["kitchen"]
        kitchen.add_agent("cook", "")
        async with view(hall) as address, view(systems["lab"]) as other, chromium() as page:
            await page.open(address)
            await page.click("#tab-fleet")
            await page.wait_for("document.querySelector('.member a')")
            await page.wait_for("document.querySelectorAll('.member')[1].innerText.includes('cook')")
            cards = await _cards(page)
            assert [card.split()[0] for card in cards] == ["hall", "kitchen", "lab"]
            assert "this system" in cards[0]
            assert "ms there and back" in cards[1]
            link = await page.evaluate("document.querySelector('.member a').href")
            assert other.startswith(link)
            assert link != other
            systems.network.cut("hall", "kitchen")
            await page.wait_for("document.querySelector('.member.lost')")
            assert "cook" in (await _cards(page))[1], "the agents that are missed are named"
            assert "1 of them does not answer" in await page.text("#fleet")
            systems.network.heal("hall", "kitchen")
            await page.wait_for("!document.querySelector('.member.lost')")
            async with AsyncExitStack() as stack:
                await systems.join(stack, "yard")
                await page.wait_for("document.querySelectorAll('.member').length === 4")
            await page.wait_for("document.querySelectorAll('.member').length === 3")
            assert page.errors == []

    run(scene, "hall", "lab", "kitchen", clock="real")


@needs_chromium
def test_an_invalid_address_is_not_a_link() -> None:
    async def scene(systems: Fleet) -> None:
        systems["lab"].system.fleet.show_page("javascript:alert(1)")  # type: ignore[union-attr]
        async with view(systems["hall"]) as address, chromium() as page:
            await page.open(address)
            await page.click("#tab-fleet")
            await page.wait_for("document.querySelector('#fleet').innerText.includes('javascript:alert(1)')")
            assert await page.evaluate("document.querySelector('.member a')") is None

    run(scene, "hall", "lab", clock="real")


def test_a_system_without_a_fleet_records_no_members() -> None:
    async def main() -> None:
        async with Mas(on_print=lambda *_: None) as mas:
            mas.system.keep_history()
            await mas.sleep(3)
            assert members(mas) == []

    jacaros.run(main(), clock="fast")
