"""What notebooks show of systems, agents and recordings."""

import re
from xml.etree import ElementTree

from jacaros import Mas, PythonAgent
from jacaros.look.page.picture import Picture, picture_svg
from jacaros.look.page.recorder import record
from jacaros.look.records.recording import Recording

HOSTILE = "<script>alert(1)</script>&\"'"


class Idle(PythonAgent):
    """Does nothing."""


def rows(shown: str) -> list[list[str]]:
    """Return the texts of the cells of all tables; fails unless they are well-formed."""
    tree = ElementTree.fromstring(f"<all>{shown}</all>")
    return [["".join(cell.itertext()) for cell in row] for row in tree.iter("tr")]


async def test_an_agent_is_shown_as_tables(mas: Mas) -> None:
    bob = mas.add_agent("bob", "+!go(_) <- !wait. +!wait <- .wait(1000).")
    bob.add_belief("seen(Text)[source(ann)]", Text=HOSTILE)
    bob.post_goal("go", 1)
    await mas.sleep(0.1)
    shown = bob._repr_html_()
    assert "<script" not in shown
    assert rows(shown) == [
        ["belief", "annotations"],
        [f'seen("{HOSTILE}")', "source(ann)"],
        ["intention", "state", "goals, the current one first"],
        ["1", "waiting", "wait, go(1)"],
    ]
    bob.kill()
    assert "&lt;agent bob (ended)&gt;" in bob._repr_html_()


async def test_long_tables_and_terms_are_cut(mas: Mas) -> None:
    bob = mas.add_agent("bob", "")
    bob.add_belief("scan", list(range(10_000)))
    bob.add_belief("page", "x" * 10_000)
    for number in range(150):
        bob.add_belief("n", number)
    shown = rows(bob._repr_html_())
    assert len(shown) == 103
    assert shown[101] == ["..."]
    assert max(len(cell) for row in shown for cell in row) == 203


async def test_a_system_is_shown_as_tables_of_its_agents(mas: Mas) -> None:
    mas.add_agent("bob", "p(1). p(2). !wait. +!wait <- .wait(1000).")
    mas.add_agent("<b>", "")
    mas.add_agent("py", Idle)
    await mas.sleep(0.1)
    shown = rows(mas._repr_html_())
    assert shown[:4] == [
        ["agent", "beliefs", "intentions"],
        ["bob", "2", "1"],
        ["<b>", "0", "0"],
        ["py", "written in Python"],
    ]
    assert ["p(2)", "source(self)"] in shown


async def test_a_system_is_shown_before_and_after_its_run() -> None:
    mas = Mas(name="<lab>")
    assert "&lt;Mas &lt;lab&gt;, not begun&gt;" in mas._repr_html_()
    async with mas:
        mas.add_agent("bob", "p(1).")
    assert "ended with exit code 0" in mas._repr_html_()


async def test_a_recording_is_shown_as_a_picture() -> None:
    async with Mas(world="empty", seed=1) as mas:
        assert mas.world is not None
        with record(mas) as recording:
            await mas.sleep(1)
    assert recording is not None
    shown = Picture(recording, width=300)._repr_svg_()
    assert shown == picture_svg(recording, 300)
    assert re.match(r"<svg [^>]*width=\"300\"", shown)
    assert Picture(Recording())._repr_svg_().startswith("<svg ")
