"""Programs that run inside the harness and import the files beside them."""

import sys
from pathlib import Path

import pytest

from beside import importing_beside


def program(folder: Path, word: str) -> Path:
    folder.mkdir()
    (folder / "a_word.py").write_text(f"WORD = {word!r}\n")
    return folder / "program.py"


def test_each_program_imports_the_files_beside_itself(tmp_path: Path) -> None:
    for word in ("one", "two"):
        with importing_beside(program(tmp_path / word, word)):
            import a_word  # type: ignore[import-not-found]

            assert word == a_word.WORD


def fail_after_an_import(path: Path) -> None:
    with importing_beside(path):
        import a_word  # noqa: F401

        raise RuntimeError("the program fails")


def test_nothing_is_left_behind(tmp_path: Path) -> None:
    path, before = list(sys.path), set(sys.modules)
    with pytest.raises(RuntimeError):
        fail_after_an_import(program(tmp_path / "one", "one"))
    assert sys.path == path
    assert set(sys.modules) == before
