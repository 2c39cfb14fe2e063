"""The engine of a run is one of its options; the environment only names the default."""

from pathlib import Path
from typing import Any

import pytest

from jacaros.agents.mind.generated.compiler import Compiler
from jacaros.runtime.mas.launch import launch
from jacaros.runtime.mas.options import RunOptions


class Console:
    """Keeps nothing."""

    def print(self, agent: str, text: str) -> None:
        """Ignore output."""

    def log(self, text: str, level: str = "info") -> None:
        """Ignore messages."""


@pytest.mark.parametrize(("variable", "plain"), [("1", True), ("0", False), ("", False)])
def test_the_environment_names_the_default(variable: str, plain: bool, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("JACAROS_PLAIN", variable)
    assert RunOptions().plain is plain
    assert not RunOptions(plain=False).plain


def test_two_runs_of_one_process_have_engines_of_their_own(tmp_path: Path) -> None:
    program = tmp_path / "one.asl"
    program.write_text("!go. +!go <- .stopMAS.")
    engines: list[Any] = []
    for plain in (True, False):
        options = RunOptions(fast=True, plain=plain)
        launch(
            program,
            options,
            Console(),
            lambda mas: engines.extend(host.mind.engine for host in mas.directory),
        )
    assert [isinstance(engine, Compiler) for engine in engines] == [False, True]
