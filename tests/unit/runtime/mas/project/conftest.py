"""Project files that are written, read and loaded in the folder of a test."""

from collections.abc import Callable
from pathlib import Path
from textwrap import dedent

import pytest

from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.runtime.mas.deployment import Deployment, ProjectError
from jacaros.runtime.mas.launch import load_deployment
from jacaros.runtime.mas.project.reading import read_project


@pytest.fixture
def write(folder: Path) -> Callable[..., Path]:
    """Writes a text; one of a project may do without a name."""

    def write(text: str, name: str = "") -> Path:
        path = folder / (name or ("p.mas2j" if "MAS " in text else "p.jcm"))
        path.write_text(dedent(text), encoding="utf-8")
        return path

    return write


@pytest.fixture
def load(write: Callable[..., Path]) -> Callable[[str], Deployment]:
    return lambda text: load_deployment(write(text))


@pytest.fixture
def report(folder: Path, load: Callable[[str], Deployment]) -> Callable[[str], str]:
    """Loads a project that is refused."""

    def report(text: str) -> str:
        with pytest.raises(ProjectError) as refused:
            load(text)
        return str(refused.value).replace(f"{folder}/", "")

    return report


@pytest.fixture
def diagnostics(write: Callable[..., Path]) -> Callable[[str], list[Diagnostic]]:
    return lambda text: read_project(write(text)).diagnostics
