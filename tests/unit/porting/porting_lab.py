"""The Java files of these tests, and their ports."""

from collections.abc import Callable
from pathlib import Path
from types import ModuleType

from jacaros.porting import Ported, port

JAVA = Path(__file__).parent / "java"

Loaded = Callable[[str], ModuleType]


def ported(name: str) -> Ported:
    """Return the port of one of the Java files."""
    return port(name, (JAVA / name).read_text(encoding="utf-8"))
