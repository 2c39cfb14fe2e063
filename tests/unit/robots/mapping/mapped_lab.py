"""Mapped artifacts in the laboratory."""

import asyncio

from jacaros.robots.mapping.artifact import MappedArtifact, mapped_type
from jacaros.robots.mapping.file import read_mapping


def mapped(text: str) -> type[MappedArtifact]:
    """The class that a mapping file declares."""
    return mapped_type(read_mapping(text, "m.yaml"), "m")


async def settle() -> None:
    """Let everything happen that needs no time."""
    for _ in range(30):
        await asyncio.sleep(0)


def mistakes(texts: str) -> dict[str, str]:
    """The texts of mapping files, one a line, and what is said of each: the indented lines below it."""
    found: dict[str, str] = {}
    text = ""
    for line in texts.strip().splitlines():
        if line.startswith("  "):
            found[text] = " ".join([*filter(None, [found[text]]), line.strip()])
        else:
            text = line.replace("\\n", "\n")
            found[text] = ""
    return found
