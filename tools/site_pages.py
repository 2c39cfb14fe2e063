"""The pages of the site as a generator reads them: copied from the repository, links and blocks of code adapted.

The sources are written for the code host, where links lead through the repository and a block of code names its file.
The site has only some of the repository's files, so every other link leads to the code host.
"""

import os
import re
import shutil
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
HOST = "https://github.com/jacaros/jacaros/blob/main"
INDEX = Path("docs/index.md")

_FENCE = re.compile(r"^( *)```([^\n]*)\n(.*?)^\1```$", re.MULTILINE | re.DOTALL)
_LINK = re.compile(r"(!?\[(?:[^\[\]]|\[[^\]]*\])*\]\()([^)\s]+)(\))")
_SECTION = re.compile(r"^<!-- section (\S+?)#(\S+) -->$", re.MULTILINE)
API = (
    "jacaros",
    "jacaros.artifacts",
    "jacaros.artifacts.behaviour_trees",
    "jacaros.look",
    "jacaros.robots.kit",
    "jacaros.testing",
)
"""What is public in Python, see docs/reference/stability.md: a page from the docstrings for each."""

Menu = dict[str, Any]
"""A heading of the menu, with a page, or the pages and headings below it."""

_CHECKED = ("wrong", "right", "formatted")
"""Words behind the language of a block that only its test reads."""
_PROJECT = ("CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md")


class BrokenPage(Exception):
    """A page links to a file that does not exist, or includes a section that does not exist."""


def sources() -> dict[Path, Path]:
    """Return the place on the site of each file of the repository that the site has."""
    places = {
        Path("site/home.md"): Path("index.md"),
        Path("site/api/index.md"): Path("api/index.md"),
        INDEX: Path("map.md"),
    }
    for folder in ("docs", "examples"):
        for file in sorted((ROOT / folder).rglob("*.*")):
            source = file.relative_to(ROOT)
            if source in places or not _is_shown(source):
                continue
            inside = source.relative_to("docs") if folder == "docs" else source
            places[source] = inside.with_name("index.md") if inside.name == "README.md" else inside
    return places | {Path(name): Path("project", name.lower()) for name in _PROJECT}


def _is_shown(source: Path) -> bool:
    return source.suffix == ".md" or source.parent == Path("docs/images")


def copy_pages(target: Path) -> None:
    """Write all pages and pictures to *target*."""
    places = sources()
    for source, place in places.items():
        (target / place).parent.mkdir(parents=True, exist_ok=True)
        if source.suffix == ".md":
            (target / place).write_text(page(source, places), encoding="utf-8")
        else:
            shutil.copyfile(ROOT / source, target / place)
    for module in API:
        text = f"# {module}\n\n::: {module}\n    options: {{show_root_heading: false, show_root_toc_entry: false}}\n"
        (target / _api_page(module)).write_text(text, encoding="utf-8")


def page(source: Path, places: dict[Path, Path]) -> str:
    """Return the text of a page as the generator reads it."""
    text = (ROOT / source).read_text(encoding="utf-8")
    text = _adapt(text, source, places[source], places)
    return _SECTION.sub(lambda found: _section(found[1], found[2], places[source], places), text)


def _adapt(text: str, source: Path, place: Path, places: dict[Path, Path]) -> str:
    """Adapt the blocks of code of a text, and the links outside them."""
    parts, end = [], 0
    for fence in _FENCE.finditer(text):
        parts += [_prose(text[end : fence.start()], source, place, places), _block(fence)]
        end = fence.end()
    return "".join(parts) + _prose(text[end:], source, place, places)


def _section(name: str, anchor: str, place: Path, places: dict[Path, Path]) -> str:
    """Return a section of another page, without its heading."""
    text = (ROOT / name).read_text(encoding="utf-8")
    for found in re.finditer(r"^## ([^\n]+)\n(.*?)(?=^## |\Z)", text, re.MULTILINE | re.DOTALL):
        if found[1].strip().lower().replace(" ", "-") == anchor:
            return _adapt(found[2].strip(), Path(name), place, places)
    raise BrokenPage(f"{name} has no section #{anchor}")


def _block(fence: re.Match[str]) -> str:
    """Return a block of code in the words of the generator: the file that it names becomes its title."""
    language, *purpose = fence[2].split() or ["text"]
    title = purpose[-1] if purpose else ""
    if language == "console" or title in _CHECKED or (purpose and purpose[0] in _CHECKED):
        title = ""
    if language in ("output", "errors"):
        language, title = "text", language
    shown = f' title="{title}"' if title else ""
    return f"{fence[1]}```{language}{shown}\n{fence[3]}{fence[1]}```"


def _prose(text: str, source: Path, place: Path, places: dict[Path, Path]) -> str:
    """Adapt what stands between blocks of code: links, and Markdown inside of HTML, which the code host reads as such."""
    text = text.replace("<details>", '<details markdown="1">')
    return _LINK.sub(lambda found: found[1] + _link(found[2], source, place, places) + found[3], text)


def _link(link: str, source: Path, place: Path, places: dict[Path, Path]) -> str:
    """Return the link on the site: relative between pages of the site, to the code host otherwise."""
    if "://" in link or link.startswith(("#", "mailto:")):
        return link
    name, mark, anchor = link.partition("#")
    file = Path(os.path.normpath(source.parent / name))
    if not (ROOT / file).exists():
        raise BrokenPage(f"{source}: link to {link}, which does not exist")
    for candidate in (file, file / "README.md", file / "index.md"):
        if candidate in places:
            return os.path.relpath(places[candidate], place.parent).replace(os.sep, "/") + mark + anchor
    return f"{HOST}/{file.as_posix()}{mark}{anchor}"


def navigation(places: dict[Path, Path]) -> list[Menu]:
    """Return the menu: the parts of docs/index.md in its order, and behind them what is about the project itself."""
    text = (ROOT / INDEX).read_text(encoding="utf-8")
    menu: list[Menu] = [{"Home": "index.md"}]
    for title, body in _divided(text, r"^## (.+)$")[1]:
        if title == "Reference":
            menu.append(
                {title: [*_groups(body, places), {"Python API": ["api/index.md", *map(_api_page, API)]}]}
            )
        elif title != "Decisions":
            menu.append({title: _groups(body, places)})
    examples = [place.as_posix() for place in places.values() if place.parts[0] == "examples"]
    decisions = [place.as_posix() for place in places.values() if place.parts[0] == "decisions"]
    project = [places[Path(name)].as_posix() for name in _PROJECT]
    return [*menu, {"Examples": examples}, {"Project": [*project, {"Decisions": decisions}]}]


def _groups(text: str, places: dict[Path, Path]) -> list[Any]:
    """Return the pages of a part, below the bold lines in it if there are any."""
    first, groups = _divided(text, r"^\*\*(.+)\*\*$")
    return [*_pages_in(first, places), *({title: _pages_in(body, places)} for title, body in groups)]


def _divided(text: str, heading: str) -> tuple[str, list[tuple[str, str]]]:
    """Divide a text at its headings: what stands before the first, and each heading with what follows."""
    first, *rest = re.split(heading, text, flags=re.MULTILINE)
    return first, list(zip(rest[::2], rest[1::2], strict=True))


def _pages_in(text: str, places: dict[Path, Path]) -> list[str]:
    """Return the pages of the documentation that a text links to."""
    targets = [found[2].partition("#")[0] for found in _LINK.finditer(text)]
    files = [Path(os.path.normpath(INDEX.parent / target)) for target in targets]
    shown = [places[file].as_posix() for file in files if file in places and file.parts[0] == "docs"]
    return list(dict.fromkeys(shown))


def _api_page(module: str) -> str:
    return f"api/{module}.md"
