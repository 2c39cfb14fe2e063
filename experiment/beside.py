"""A program that runs inside this process imports the files beside it, as ``python FILE`` lets it."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def importing_beside(program: Path) -> Iterator[None]:
    """Let imports find the files beside *program* in this context; the next program imports its own anew."""
    folder = str(program.parent)
    before = set(sys.modules)
    sys.path.insert(0, folder)
    try:
        yield
    finally:
        sys.path.remove(folder)
        for name in set(sys.modules) - before:
            if str(Path(getattr(sys.modules[name], "__file__", None) or "").parent) == folder:
                del sys.modules[name]
