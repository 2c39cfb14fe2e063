"""Run one project on JaCaROS and print what it cost, as JSON (see `marks.Marks.report`), and how many cycles it had.

on_jacaros.py PROJECT
"""

import json
import os
import sys
from typing import Any

from marks import Marks

from jacaros.runtime.mas.launch import launch
from jacaros.runtime.mas.options import RunOptions


class Listener:
    """The console of the run."""

    def __init__(self) -> None:
        self.marks = Marks()

    def print(self, agent: str, text: str) -> None:
        """Take a mark."""
        self.marks.take(text)

    def log(self, text: str, level: str = "info") -> None:
        """End the run on an error: the program would wait forever."""
        if level == "error":
            print(text, file=sys.stderr, flush=True)
            os._exit(1)


def main(project: str) -> None:
    """Run it as the command does, on the virtual clock."""
    minds: list[Any] = []
    listener = Listener()
    code = launch(
        project,
        RunOptions(fast=True, seed=0),
        listener,
        lambda mas: minds.extend(host.mind for host in mas.directory),
    )
    if code or not listener.marks.seconds:
        sys.exit(f"exit code {code}, {len(listener.marks.seconds)} measurements")
    print(json.dumps(listener.marks.report() | {"cycles": sum(mind.counts.cycles for mind in minds)}))


if __name__ == "__main__":
    main(sys.argv[1])
