"""Where programs and included files are found: one rule for projects, single programs, includes and created agents."""

import os
import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final

from jacaros.agents import language
from jacaros.files.texts import file_text, is_file

_USUAL: Final = (
    *(".", "src/agt", "src/agt/inc", "src/asl", "asl", "agents", "inc"),
    *(f"src/test/{each}" for each in ("jason/inc", "jason/asl", "inc", "agt")),
)
"""Folders of a project that have programs in the layouts of Jason, JaCaMo and ROS."""
PROJECTS: Final = (".jcm", ".mas2j")
_PROGRAMS: Final = (".asl", ".py")
_ROOTS: Final = (".git", "pyproject.toml", "build.gradle", "package.xml", "setup.py")
_LEVELS: Final = 6
_LIBRARY: Final = "$jacaros/"
_LIBRARY_FOLDER: Final = Path(language.__file__).parent / "library"
TEST_LIBRARY: Final = (
    "mock_agent.asl",
    "test_assert.asl",
    "test_manager.asl",
    "test_performance.asl",
    "tester_agent.asl",
)
"""Files that Jason programs include for tests. Those of JaCaROS replace them."""
_OF_JASON: Final = re.compile(r"\$jason(Jar)?/test/jason/inc/|\btest_manager\b|\bmock_owner\b")
"""Text that identifies Jason's own copies of them, which projects have beside their tests."""


def project_folders(folder: Path) -> list[Path]:
    """Return a folder and those above it, up to the root of its project."""
    found = [folder]
    above = start = Path(os.path.abspath(folder))
    relative = folder
    for _ in range(_LEVELS):
        if above != start and _is_root(above):
            return found
        if above.parent == above or (above / ".git").exists():
            break
        above, relative = above.parent, relative / ".."
        found.append(Path(os.path.normpath(relative)))
    return [folder]


def _is_root(folder: Path) -> bool:
    try:
        return any(name in _ROOTS or name.endswith(PROJECTS) for name in os.listdir(folder))
    except OSError:  # a folder that others must not read
        return False


def source_folders(base: Path, declared: Sequence[str] = (), above: Sequence[Path] = ()) -> tuple[Path, ...]:
    """Return the folders that are searched for the programs of a project, in order.

    They are the *declared* folders, then the usual ones: below the folder *base* of the project file, those *above* it,
    and, as in Jason and JaCaMo, the working folder. Missing folders are left out, except for declared ones below *base*.
    """
    places = [base, *above, Path()]
    written = [place / name for place in places for name in declared]
    usual = [place / name for place in places for name in _USUAL]
    required = written[: len(declared)]
    return _distinct([*required, *(folder for folder in (*written, *usual) if folder.is_dir())])


def _distinct(folders: Iterable[Path]) -> tuple[Path, ...]:
    found: dict[str, Path] = {}
    for folder in folders:
        found.setdefault(os.path.abspath(folder), folder)
    return tuple(found.values())


class SourcePath:
    """The folders that are searched for programs and included files, and the library of JaCaROS.

    Attributes:
        folders: the folders, in order.
    """

    def __init__(self, folders: Iterable[Path]) -> None:
        self.folders = _distinct(folders)

    def find(self, name: str) -> Path:
        """Return the file of a program, with or without ``.asl`` in its name.

        ``$jacaros/NAME`` is a file of the library. The library also has the files that Jason programs include for tests,
        whatever folder is written before their name; a project's own file of that name comes first.

        Raises:
            FileNotFoundError: it does not exist; the text says where it was searched.
        """
        if name.startswith(_LIBRARY):
            return _library_file(name.removeprefix(_LIBRARY))
        name = name.removeprefix("file:")
        candidates = [name] if name.endswith(_PROGRAMS) else [f"{name}.asl", name]
        for folder in self.folders:
            for candidate in candidates:
                if is_file(folder / candidate):
                    return folder / candidate
        last = candidates[0].rpartition("/")[2]
        if last in TEST_LIBRARY:
            return _library_file(last)
        if "://" in name:
            raise FileNotFoundError("download the program: only files are supported")
        raise FileNotFoundError(f"expected in {', '.join(map(str, self.folders))}")

    def include(self, path: str, including: str) -> tuple[str, str]:
        """Return name and text of an included file: beside the including one, or else as `find`.

        Copies of Jason's files for tests are replaced by those of the library.

        Raises:
            FileNotFoundError: it does not exist; the text says where it was searched.
        """
        # A program that is not in a file has no files beside it.
        beside = () if including.startswith(("<", "$")) else (Path(including).parent,)
        file = SourcePath((*beside, *self.folders)).find(path)
        text = file_text(file)
        if file.name in TEST_LIBRARY and file.parent != _LIBRARY_FOLDER and _OF_JASON.search(text):
            file = _library_file(file.name)
            text = file_text(file)
        return name_of(file), text


def name_of(file: Path) -> str:
    """Return the name of a program file in diagnostics: ``$jacaros/NAME`` in the library."""
    return f"{_LIBRARY}{file.name}" if file.parent == _LIBRARY_FOLDER else file.as_posix()


def _library_file(name: str) -> Path:
    file = _LIBRARY_FOLDER / name
    if not is_file(file):
        shipped = sorted(each.name for each in _LIBRARY_FOLDER.glob("*.asl"))
        raise FileNotFoundError(f"the library has {', '.join(shipped)}")
    return file
