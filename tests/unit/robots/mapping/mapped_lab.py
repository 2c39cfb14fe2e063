"""Mapped artifacts in the laboratory."""

import asyncio
from collections.abc import Awaitable, Callable

from robot_lab import Lab, in_lab

from jacaros.artifacts import ArtifactId
from jacaros.robots.mapping.artifact import MappedArtifact, mapped_type
from jacaros.robots.mapping.file import read_mapping


def mapped(text: str) -> type[MappedArtifact]:
    """The class that a mapping file declares."""
    return mapped_type(read_mapping(text, "m.yaml"), "m")


async def settle() -> None:
    """Let everything happen that needs no time."""
    for _ in range(30):
        await asyncio.sleep(0)


def with_mapped(
    text: str,
    body: Callable[[Lab, ArtifactId], Awaitable[None]],
    *arguments: object,
    world: str | None = None,
) -> Lab:
    """Run *body* with one mapped artifact."""

    async def in_it(lab: Lab) -> None:
        await body(lab, await lab.make(mapped(text), *arguments))

    return in_lab(in_it, world)


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
