"""The Python files of a project, and the libraries that they import."""

import sys
from pathlib import Path

import pytest

from jacaros.runtime.files.python_modules import ProjectModules


@pytest.mark.parametrize(("where", "times"), [(".venv/lib/python3.11/site-packages", 1), ("more", 2)])
def test_a_library_of_an_environment_inside_the_project_is_loaded_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, where: str, times: int
) -> None:
    folder = tmp_path / where
    folder.mkdir(parents=True)
    (folder / "counted_library.py").write_text(
        "import sys\nsys.loads_of_library = getattr(sys, 'loads_of_library', 0) + 1\n"
    )
    (tmp_path / "artifacts.py").write_text("import counted_library\n")
    monkeypatch.syspath_prepend(str(folder))
    monkeypatch.setattr(sys, "loads_of_library", 0, raising=False)
    try:
        for _ in range(2):
            assert ProjectModules(tmp_path).load("artifacts")
        assert sys.loads_of_library == times  # type: ignore[attr-defined]
    finally:
        sys.modules.pop("counted_library", None)
