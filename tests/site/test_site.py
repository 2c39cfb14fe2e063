"""The built site in a browser: every page is usable on a laptop and, dark, on a phone, and comes from this site alone."""

import asyncio
import functools
import re
import subprocess
import sys
import threading
from collections.abc import Iterator
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import pytest
from devtools import Page, chromium, needs_chromium

ROOT = Path(__file__).parents[2]
AXE = ROOT / "site" / "node_modules" / "axe-core" / "axe.min.js"
PARTS = ("", "api", "decisions", "examples", "explanation", "how-to", "project", "reference", "tutorial")
FOUND = "[...document.querySelectorAll('*')].flatMap((each) => [...(each.shadowRoot?.querySelectorAll('a') ?? [])])"
"""The results of a search, which the theme keeps in a tree of its own."""
INDEXING = 180.0
"""Seconds that the theme's worker may take for its index while the other parts of the tests run."""
SCHEMES = {"light": "default", "dark": "slate"}
"""The theme's names of schemes."""
LOOKS = (("light", 1440, 900), ("dark", 390, 844))
"""Schemes and sizes, a laptop and a phone. Colours depend on the scheme alone, the layout on the width, and four looks took
half an hour of a busy machine."""
SERIOUS = """
axe.run({preload: false, resultTypes: ["violations"]}).then((found) => found.violations
  .filter((each) => ["serious", "critical"].includes(each.impact))
  .map((each) => `${each.id}: ${each.nodes[0].html.slice(0, 200)} ${each.nodes[0].failureSummary}`))
"""
ELSEWHERE = """
performance.getEntriesByType("resource").map((each) => each.name).filter((name) => !name.startsWith(location.origin))
"""


class Quiet(SimpleHTTPRequestHandler):
    """Serves files without a log."""

    def log_message(self, *_: Any) -> None:
        """Write nothing."""


@pytest.fixture(scope="session")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build the site; a warning fails."""
    folder = tmp_path_factory.mktemp("site")
    command = (sys.executable, str(ROOT / "tools" / "make_site.py"), str(folder))
    built = subprocess.run(command, capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stdout + built.stderr
    return Path(built.stdout.splitlines()[-1]).parent


@pytest.fixture(scope="session")
def address(site: Path) -> Iterator[str]:
    """Serve the site, with its menu of versions, and return its address."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=str(site.parent)))
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    yield f"http://127.0.0.1:{server.server_port}/{site.name}/"
    server.shutdown()
    thread.join()
    server.server_close()


def pages(site: Path, part: str) -> list[str]:
    """Return the addresses of the pages of a folder, from the site's own; the pages above the folders for ""."""
    found = sorted(file.parent.relative_to(site).as_posix() for file in site.rglob("index.html"))
    inside = [page for page in found if page.partition("/")[0] == part or (part == "" and is_above(page))]
    return ["" if page == "." else f"{page}/" for page in inside]


def is_above(page: str) -> bool:
    return "/" not in page and page not in PARTS


def test_every_page_is_in_one_part(site: Path) -> None:
    found = [page for part in PARTS for page in pages(site, part)]
    assert len(found) == len(list(site.rglob("index.html"))) > 100


def test_no_page_names_a_file_of_another_host(site: Path) -> None:
    for file in site.rglob("*.html"):
        text = file.read_text(encoding="utf-8")
        loaded = re.findall(r'<(?:script|img|iframe|source)\b[^>]*\bsrc="(https?:[^"]+)', text)
        loaded += re.findall(
            r'<link\b(?=[^>]*rel="(?:stylesheet|icon|preconnect|preload)")[^>]*href="(https?:[^"]+)', text
        )
        assert loaded == [], file


@needs_chromium
@pytest.mark.parametrize("part", PARTS, ids=lambda part: part or "top")
def test_pages_are_accessible_fit_and_load_nothing_from_elsewhere(
    site: Path, address: str, part: str
) -> None:
    assert AXE.exists(), "npm ci --prefix site"
    assert asyncio.run(problems_of(pages(site, part), address)) == []


async def problems_of(names: list[str], address: str) -> list[str]:
    """Return the problems of pages, as two readers see them."""
    async with chromium() as page:
        # The site remembers a scheme; each look is that of a new reader.
        script = "localStorage.clear();" + AXE.read_text(encoding="utf-8")
        await page.call("Page.addScriptToEvaluateOnNewDocument", source=script)
        found: list[str] = []
        for name in names:
            for scheme, width, height in LOOKS:
                problems = await look(page, address + name, scheme, width, height)
                found += [f"{name} {scheme} {width}: {each}" for each in problems]
        return found + page.errors


async def look(page: Page, address: str, scheme: str, width: int, height: int) -> list[str]:
    """Return the problems of a page as one reader sees it."""
    await page.prefer(scheme)
    await page.resize(width, height, mobile=width < 500)
    await page.open(address)
    assert await page.evaluate("document.body.dataset.mdColorScheme") == SCHEMES[scheme]
    found = [*await page.evaluate(SERIOUS), *await page.evaluate(ELSEWHERE)]
    if await page.evaluate("document.documentElement.scrollWidth > innerWidth"):
        found.append("the page is wider than the window")
    return found


@needs_chromium
def test_a_search_finds_a_page(address: str) -> None:
    asyncio.run(search(address))


async def search(address: str) -> None:
    async with chromium() as page:
        await page.open(address)
        await page.click(".md-search__button")
        await page.type("urgency")
        await page.wait_for(f"{FOUND}.some((link) => link.href.includes('urgency'))", INDEXING)
        assert page.errors == []
