"""The Python files of a project: ``NAME.py``, or a package ``NAME/``, in its folders.

Artifacts (``artifacts.py``), internal actions, agent classes and belief bases are found here. The files are loaded under
module names of their own, so that several projects with files of the same names can live in one process; the import path
is restored after loading.
"""

import importlib.util
import itertools
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import RLock
from types import ModuleType

from jacaros.errors import JacarosError
from jacaros.module_outlines import INCOMPLETE, UNSEEN, fill
from jacaros.text_files import file_text

_numbers = itertools.count(1)
_import_path = RLock()
"""Held while `sys.path` and `sys.modules` show the files of one project: they belong to the process, so systems in other
threads have to wait.
"""


class ModuleUnreadable(JacarosError):
    """A project's Python file cannot be imported; the original error is the ``__cause__``."""


class NotImported(JacarosError):
    """Raised when the declarations of a project's Python file cannot be known without running it, which was not
    requested.
    """


class ProjectModules:
    """The Python modules of one project; each is loaded once, on first use.

    A file may import others of the project by plain names (``import gripper``) while it is loaded, and those of its
    package by relative names (``from .gripper import Gripper``). All importers share one module.

    Args:
        folders: where the files are searched, in order.
        unseen: if given, no file runs: modules are outlines (`jacaros.module_outlines`), and files with declarations that
            an outline does not show are added here when they are needed.
    """

    def __init__(self, *folders: Path | str, unseen: set[Path] | None = None) -> None:
        self.unseen = unseen
        self.folders = tuple(dict.fromkeys(Path(folder).resolve() for folder in folders))
        self._prefix = f"jacaros_project_{next(_numbers)}"
        self._loaded: dict[str, tuple[ModuleType, ...]] = {}
        # By the names under which the project's own files import them.
        self._modules: dict[str, ModuleType] = {}

    def place(self, name: str) -> Path | None:
        """Return the file or folder of a module such as ``my`` or ``my.shapes``, or None."""
        parts = name.split(".")
        if not all(part.isidentifier() for part in parts):
            return None
        for folder in self.folders:
            package = folder.joinpath(*parts)
            single = package.parent / f"{package.name}.py"
            if single.is_file():
                return single
            if package.is_dir() and next(package.glob("*.py"), None) is not None:
                return package
        return None

    def load(self, name: str) -> tuple[ModuleType, ...]:
        """Return the module called *name*; of a package, all modules, its own first. Empty if it does not exist.

        Raises:
            ModuleUnreadable: a file has an error; the text names file and line.
        """
        found = self._loaded.get(name)
        if found is None:
            place = self.place(name)
            if place is None:
                return ()
            found = self._loaded[name] = (
                (self._file(name, place),) if place.is_file() else self._package(name, place)
            )
        return found

    def require_seen(self, module: ModuleType, name: str) -> None:
        """Raise an exception unless it is known that the module lacks the name.

        Raises:
            NotImported: the module is an outline, and the name may exist when the file runs.
        """
        if self.unseen is None:
            return
        value = vars(module).get(name)
        if value is UNSEEN or (value is None and INCOMPLETE in vars(module)):
            file = Path(module.__file__ or module.__name__)
            self.unseen.add(file)
            raise NotImported(f"{file} is not imported, so {name} is not known; --import imports it")

    def loaded_files(self) -> list[Path]:
        """Return the files that have been loaded, each once."""
        files = (getattr(module, "__file__", None) for module in self._modules.values())
        return [Path(file) for file in dict.fromkeys(files) if file]

    def name_of(self, module: ModuleType) -> str:
        """The name by which the project knows a module, such as ``my.geometry``."""
        return module.__name__.removeprefix(f"{self._prefix}.")

    def _package(self, name: str, folder: Path) -> tuple[ModuleType, ...]:
        entry = folder / "__init__.py"
        first = self._file(name, entry, folder) if entry.is_file() else self._empty_package(name, folder)
        rest = [file for file in sorted(folder.glob("*.py")) if file != entry]
        return (first, *(self._file(f"{name}.{file.stem}", file) for file in rest))

    def _empty_package(self, name: str, folder: Path) -> ModuleType:
        module = self._modules.get(name) or ModuleType(f"{self._prefix}.{name}")
        module.__path__ = [str(folder)]
        sys.modules[f"{self._prefix}.{name}"] = self._modules[name] = module
        return module

    def _file(self, name: str, file: Path, package: Path | None = None) -> ModuleType:
        known = self._modules.get(name)
        if known is not None:
            return known
        full = f"{self._prefix}.{name}"
        locations = [str(package)] if package is not None else None
        spec = importlib.util.spec_from_file_location(full, file, submodule_search_locations=locations)
        assert spec is not None, file
        assert spec.loader is not None, file
        module = sys.modules[full] = self._modules[name] = importlib.util.module_from_spec(spec)
        try:
            if self.unseen is not None:
                fill(module, file, file_text(file), self._outline)
            else:
                with self._importing():
                    spec.loader.exec_module(module)
        except (Exception, SystemExit) as error:
            if isinstance(error, ModuleUnreadable) and self.unseen is not None:
                raise  # of a module that this one imports
            del sys.modules[full], self._modules[name]
            raise ModuleUnreadable(_where(error, file)) from error
        return module

    def _outline(self, name: str) -> ModuleType | None:
        """Return the outline of another module of the project that one imports."""
        name = name.removeprefix(f"{self._prefix}.")
        place = self.place(name)
        if place is None:
            return None
        if place.is_file():
            return self._file(name, place)
        entry = place / "__init__.py"
        return self._file(name, entry, place) if entry.is_file() else self._empty_package(name, place)

    @contextmanager
    def _importing(self) -> Iterator[None]:
        """Let imports find the project's files first, and take those files out of the module table again."""
        with _import_path:
            yield from self._shown()

    def _shown(self) -> Iterator[None]:
        before = set(sys.modules)
        shown = {name: module for name, module in self._modules.items() if name not in before}
        sys.modules.update(shown)
        paths = [str(folder) for folder in self.folders]
        sys.path[:0] = paths
        try:
            yield
        finally:
            for path in paths:
                sys.path.remove(path)
            for name in [name for name in list(sys.modules) if name not in before]:
                module = sys.modules[name]
                if name.startswith(f"{self._prefix}."):
                    self._modules.setdefault(name.removeprefix(f"{self._prefix}."), module)
                elif name in shown or self._is_own(module):
                    self._modules.setdefault(name, module)
                    del sys.modules[name]

    def _is_own(self, module: ModuleType) -> bool:
        file = getattr(module, "__file__", None)
        if file is None:
            return False
        path = Path(file).resolve()
        # A project's folder often holds its virtual environment, too. Libraries stay: numpy cannot be loaded twice.
        return any(
            path.is_relative_to(folder) and "site-packages" not in path.relative_to(folder).parts
            for folder in self.folders
        )


def _where(error: BaseException, file: Path) -> str:
    if isinstance(error, SyntaxError):
        return f"{error.filename}:{error.lineno}: {error.msg}"
    place, line = place_of(error, file.parent) or (file, 1)
    return f"{place}:{line}: {type(error).__name__}: {error}"


def place_of(error: BaseException, folder: Path) -> tuple[Path, int] | None:
    """Return the innermost line of a file in *folder* in the traceback of *error*, or None."""
    found = None
    step = error.__traceback__
    while step is not None:
        file = Path(step.tb_frame.f_code.co_filename)
        if file.is_relative_to(folder):
            found = (file, step.tb_lineno)
        step = step.tb_next
    return found
