"""The library modules that a program imports, directly or indirectly."""

from collections.abc import Iterable, Iterator, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Final

import jacaros
from jacaros.metrics import python_source
from jacaros.metrics.sources import PythonFile, Sources

OWN: Final = (
    *(
        f"jacaros.artifacts.{each}"
        for each in ("kit", "map", "mapping", "registry", "robots", "thesis", "tools")
    ),
    "jacaros.behaviour_trees",
)
"""Our packages that a program could contain itself. Language, middleware and simulator are the platform."""

DEFAULT: Final = ("py_trees",)
"""Third-party packages that count as library code by default."""


class Library:
    """Finds library code.

    Args:
        sources: reads the files.
        packages: names of installed top-level packages that count, in addition to `OWN`.

    Attributes:
        missing: packages that a program imports and that are not installed.
    """

    def __init__(self, sources: Sources, packages: Sequence[str] = DEFAULT) -> None:
        self._sources = sources
        root = Path(jacaros.__file__).parent.parent
        self._folders: dict[str, Path | None] = {name: root.joinpath(*name.split(".")) for name in OWN}
        self._folders.update((name, _folder(name)) for name in packages)
        self.missing: set[str] = set()

    def files(self, modules: Iterable[str]) -> Iterator[PythonFile]:
        """Yield the library files of modules, and of everything that they import within the libraries.

        Args:
            modules: names as in the program; the last part may be a name in a module.
        """
        seen: set[Path] = set()
        wanted = sorted(modules, reverse=True)
        while wanted:
            for module, path in self._found(wanted.pop()):
                if path in seen:
                    continue
                seen.add(path)
                file = self._sources.python(path)
                if file is not None:
                    yield file
                    package = module if path.name == "__init__.py" else module.rpartition(".")[0]
                    wanted += (each.absolute(package) for each in python_source.imports_of(file.tree))

    def _found(self, name: str) -> Iterator[tuple[str, Path]]:
        """Return the modules imported with *name*, as Python does: its packages, and itself."""
        for package, folder in self._folders.items():
            if name != package and not name.startswith(f"{package}."):
                continue
            if folder is None:
                self.missing.add(package)
                continue
            module, place = package, folder
            parts = name[len(package) + 1 :].split(".")
            while (place / "__init__.py").is_file():
                yield module, place / "__init__.py"
                if not parts or not parts[0]:
                    return
                module, place = f"{module}.{parts[0]}", place / parts.pop(0)
            if (file := place.with_name(f"{place.name}.py")).is_file():
                yield module, file


def _folder(package: str) -> Path | None:
    """Return the folder of an installed package, or the path of a single module without its suffix; imports nothing."""
    try:
        spec = find_spec(package)
    except (ImportError, ValueError):
        return None
    if spec is None or spec.origin is None:
        return None
    origin = Path(spec.origin)
    return origin.parent if origin.name == "__init__.py" else origin.with_suffix("")
