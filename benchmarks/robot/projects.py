"""Small projects, run as ``jacaros run --clock fast`` does, garbage collector included."""

import tempfile
import time
from pathlib import Path

from jacaros.runtime.mas.console import StandardConsole
from jacaros.runtime.mas.launch import launch
from jacaros.runtime.mas.options import RunOptions


def seconds(project: str, files: dict[str, str]) -> float:
    """Of processor time, from the first turn of an agent to the end.

    Args:
        project: name of the file that is run.
        files: texts by name of file.
    """
    began = 0.0

    def started(_: object) -> None:
        nonlocal began
        began = time.process_time()

    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            (Path(folder) / name).write_text(text, encoding="utf-8")
        options = RunOptions(fast=True, seed=0)
        code = launch(Path(folder) / project, options, StandardConsole("error"), started)
    if code:
        raise SystemExit(f"{project} ended with exit code {code}")
    return time.process_time() - began
