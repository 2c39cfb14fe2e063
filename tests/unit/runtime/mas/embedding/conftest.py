"""Scenes in a system of their own."""

from pathlib import Path

import pytest
from embedding_lab import Test, run


@pytest.fixture(autouse=True)
def play(lines: list[str], logs: list[str], tmp_path: Path):
    def play(scene: Test) -> None:
        run(lambda mas: scene(mas=mas), lines, logs, folder=tmp_path)

    return play
