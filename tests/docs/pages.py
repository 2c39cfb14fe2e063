"""The pages of the documentation as data: their blocks of code, links and words in code font.

What stands behind the language of a block says what becomes of it::

    ```agentspeak hello.asl        a file that the page's commands find
    ```console                     commands that are run, with what they print ("..." stands for any lines);
                                   `following` tells of those that only some readers or other terminals run
    ```diff robot.yaml             what to change in a file
    ```output                      what the file before it prints (see `examples`)
    ```errors                      other output when that file is run
    ```sh                          commands that are only read: set-up, real robots
    ```agentspeak wrong CODE       a program for which `jacaros check` tells this code, and nothing else;
                                   after `// better:`, one for which it tells nothing
    ```agentspeak right CODE       one for which it tells nothing
    ```agentspeak formatted        a program as `jacaros fmt` lays it out
    ```python excerpt src/a.py     lines that stand in that file, in this order ("..." leaves some out)
"""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]

PAGES = [
    ROOT / "README.md",
    ROOT / "CONTRIBUTING.md",
    ROOT / "site" / "home.md",
    *sorted((ROOT / "docs").rglob("*.md")),
]
PAGES += sorted((ROOT / "examples").rglob("*.md"))

_FENCE = re.compile(r"^( *)```([^\n]*)\n(.*?)^\1```$", re.MULTILINE | re.DOTALL)


class Block(NamedTuple):
    """A block of code.

    Attributes:
        language: the first word behind the fence.
        purpose: the rest of it, such as a file name.
        text: what stands in it.
        line: where it begins.
    """

    language: str
    purpose: str
    text: str
    line: int


def name_of(page: Path) -> str:
    """What a test calls a page."""
    return page.relative_to(ROOT).as_posix()


def blocks(page: Path) -> Iterator[Block]:
    """The blocks of code of a page."""
    text = page.read_text(encoding="utf-8")
    for fence in _FENCE.finditer(text):
        language, _, purpose = fence[2].strip().partition(" ")
        lines = [line.removeprefix(fence[1]) for line in fence[3].splitlines()]
        yield Block(
            language, purpose.strip(), "\n".join(lines) + "\n", text.count("\n", 0, fence.start()) + 1
        )


def is_file(block: Block) -> bool:
    """Whether a block is a file that commands or examples may use."""
    others = ("excerpt", "wrong", "right", "formatted")
    if block.language in ("console", "diff"):
        return False
    return bool(block.purpose) and block.purpose.partition(" ")[0] not in others


def prose(page: Path) -> str:
    """A page without its blocks of code."""
    return _FENCE.sub("", page.read_text(encoding="utf-8"))


def links(page: Path) -> Iterator[str]:
    """Targets of the links and pictures of a page."""
    for match in re.finditer(r"!?\[[^\]]*\]\(([^)\s]+)\)", prose(page)):
        yield match[1]


def code_words(page: Path) -> Iterator[str]:
    """Words in code font."""
    for match in re.finditer(r"`([^`\n]+)`", prose(page)):
        yield match[1]
