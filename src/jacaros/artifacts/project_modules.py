"""The artifacts that a project brings along: ``artifacts.py``, or a package ``artifacts/``, in its folder.

They are loaded under module names of their own, so that several projects with files of the same names can
live in one process; the import path is as before when the loading is over.
"""

import importlib.util
import itertools
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType

from jacaros.errors import JacarosError

_numbers = itertools.count(1)


class ArtifactsUnreadable(JacarosError):
    """A project's artifact file does not load; the original error is the ``__cause__``."""


def load_project_modules(folder: Path | str) -> tuple[ModuleType, ...]:
    """Load the artifacts of the project in *folder*; empty when it brings none.

    The files may import others of their folder by plain names (``import gripper``) at load time, and those
    of a package by relative names (``from .gripper import Gripper``); both stay private to the project.

    Raises:
        ArtifactsUnreadable: a file has a mistake; the text names file and line.
    """
    folder = Path(folder).resolve()
    single, package = folder / "artifacts.py", folder / "artifacts"
    name = f"jacaros_project_{next(_numbers)}_artifacts"
    if single.is_file():
        return (_load(name, single, folder),)
    if package.is_dir():
        return _load_package(name, package, folder)
    return ()


def _load_package(name: str, package: Path, folder: Path) -> tuple[ModuleType, ...]:
    entry = package / "__init__.py"
    if entry.is_file():
        modules = [_load(name, entry, folder, package)]
    else:
        modules = [sys.modules.setdefault(name, _empty_package(name, package))]
    for file in sorted(package.glob("*.py")):
        if file != entry:
            full = f"{name}.{file.stem}"
            modules.append(sys.modules.get(full) or _load(full, file, folder))
    return tuple(modules)


def _empty_package(name: str, package: Path) -> ModuleType:
    module = ModuleType(name)
    module.__path__ = [str(package)]
    return module


def _load(name: str, file: Path, folder: Path, package: Path | None = None) -> ModuleType:
    locations = [str(package)] if package is not None else None
    spec = importlib.util.spec_from_file_location(name, file, submodule_search_locations=locations)
    if spec is None or spec.loader is None:
        raise ArtifactsUnreadable(f"{file} is not a Python file")
    module = sys.modules[name] = importlib.util.module_from_spec(spec)
    try:
        with _importing_from(folder):
            spec.loader.exec_module(module)
    except Exception as error:
        del sys.modules[name]
        raise ArtifactsUnreadable(_where(error, file)) from error
    return module


@contextmanager
def _importing_from(folder: Path) -> Iterator[None]:
    """Let imports find the project's files first, and take those files out of the module table again."""
    before = dict(sys.modules)
    sys.path.insert(0, str(folder))
    try:
        yield
    finally:
        sys.path.remove(str(folder))
        for name in [name for name in sys.modules if name not in before]:
            if not name.startswith("jacaros_project_") and _lies_in(sys.modules[name], folder):
                del sys.modules[name]


def _lies_in(module: ModuleType, folder: Path) -> bool:
    file = getattr(module, "__file__", None)
    return file is not None and Path(file).resolve().is_relative_to(folder)


def _where(error: Exception, file: Path) -> str:
    if isinstance(error, SyntaxError):
        return f"{error.filename}:{error.lineno}: {error.msg}"
    line, place = 0, file
    step = error.__traceback__
    while step is not None:
        if Path(step.tb_frame.f_code.co_filename).is_relative_to(file.parent):
            line, place = step.tb_lineno, Path(step.tb_frame.f_code.co_filename)
        step = step.tb_next
    return f"{place}:{line}: {type(error).__name__}: {error}"
