"""Links have targets, pictures exist, and the documentation is complete."""

import re
from pathlib import Path
from xml.etree import ElementTree

import pytest
from pages import PAGES, ROOT, blocks, links, name_of

from jacaros.agents.language.formatting import format_program
from jacaros.runtime.cli.run import PROGRAM


def anchors(page: Path) -> set[str]:
    """Return the anchors in links to *page*."""
    found = set()
    for heading in re.findall(r"^#+ +(.+)$", page.read_text(encoding="utf-8"), flags=re.MULTILINE):
        words = re.sub(r"[^\w\- ]", "", heading.lower().replace("`", ""))
        found.add(words.strip().replace(" ", "-"))
    return found


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_links_have_a_target(page: Path) -> None:
    for link in links(page):
        if "://" in link:
            continue
        target, _, anchor = link.partition("#")
        file = (page.parent / target).resolve() if target else page
        assert file.exists(), f"{name_of(page)}: {link}"
        if anchor:
            assert anchor in anchors(file), f"{name_of(page)}: {link}"


def test_the_index_names_every_page() -> None:
    index = ROOT / "docs" / "index.md"
    named = {(index.parent / link.partition("#")[0]).resolve() for link in links(index)}
    pages = {page for page in (ROOT / "docs").rglob("*.md") if page != index}
    assert sorted(str(page) for page in pages - named) == []


def test_pictures_are_self_contained() -> None:
    pictures = sorted((ROOT / "docs" / "images").glob("*.svg"))
    assert pictures
    for picture in pictures:
        text = picture.read_text(encoding="utf-8")
        assert ElementTree.fromstring(text).tag.endswith("svg")
        assert "http" not in text.replace("http://www.w3.org/2000/svg", "")
        assert len(text) < 200_000


def test_the_first_screen_of_the_readme_has_the_picture_and_the_first_commands() -> None:
    first_screen = "\n".join((ROOT / "README.md").read_text(encoding="utf-8").splitlines()[:40])
    assert "docs/images/page.png" in first_screen
    commands = re.findall(r"^(?:make|jacaros|pip install) \w+", first_screen, flags=re.MULTILINE)
    assert commands == ["make demo", "jacaros demo", "make test"]
    for needed in ("git", "make", "3.11", "venv", ". .venv/bin/activate", "pip install jacaros"):
        assert needed in first_screen


def test_the_program_of_the_readme_is_the_one_of_the_demo() -> None:
    (shown,) = [block.text for block in blocks(ROOT / "README.md") if block.purpose == "patrol.asl"]
    assert format_program("patrol.asl", shown) == PROGRAM.read_text(encoding="utf-8")
    assert len([line for line in shown.splitlines() if line.strip()]) <= 15


def test_every_example_has_a_short_readme() -> None:
    for example in sorted((ROOT / "examples").iterdir()):
        if example.is_dir() and any(example.glob("*.jcm")):
            assert (example / "README.md").is_file(), example.name
