"""How long an editor waits for the language server with a program of 1,000 lines, and whether its memory grows.

editors.py [--edits N]      N edits for the memory, by default 10,000; each is checked and indexed

The limits are 150 ms for diagnostics and 50 ms for completion. Times are medians; "processor" leaves out other processes.
"""

import argparse
import gc
import resource
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median

from jacaros.agents.language.diagnostics import SourceFile
from jacaros.editors.lsp.projects import Projects
from jacaros.editors.symbols.completion import completions
from jacaros.editors.symbols.model import Position

LINES = 1000
TIMES = 15
_PROJECT = """mas p {
    agent robot : robot.asl
    world: "house"
}
"""
_BEGIN = """{ include("$jacaros/artifacts.asl") }

!visit_0.

+!visit_LAST.
"""
_STAGE = """
+!visit_N : visited(room_N, Level) & Level > 1000
  <- .print("too often: ", Level);
     !wait_N(Level);
     !visit_N.
+!visit_N
  <- +visited(room_N, N);
     ?visited(room_N, Count);
     .print("visit ", Count);
     !visit_NEXT.
+!wait_N(Level) : Level > 10 <- .wait(1000).
+!wait_N(_) <- .wait(5000).
"""


def program() -> str:
    """Return a program of 1,000 lines."""
    stages = (LINES - _BEGIN.count("\n")) // _STAGE.count("\n")
    parts = [_STAGE.replace("NEXT", str(each + 1)).replace("N", str(each)) for each in range(stages)]
    text = _BEGIN.replace("LAST", str(stages)) + "".join(parts)
    return text + "// end\n" * (LINES - text.count("\n"))


def timed(step: Callable[[int], object]) -> str:
    """Return the median times of a step."""
    wall, processor = [], []
    for number in range(TIMES):
        began, used = time.perf_counter(), time.process_time()
        step(number)
        wall.append(time.perf_counter() - began)
        processor.append(time.process_time() - used)
    return f"{1000 * median(wall):.0f} ms, processor {1000 * median(processor):.0f} ms"


def memory() -> float:
    """Return the memory of this process in MB."""
    gc.collect()
    if sys.platform == "linux":
        pages = int(Path("/proc/self/statm").read_text().split()[1])
        return pages * resource.getpagesize() / 2**20
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20


def main(edits: int) -> None:
    """Measure, and print."""
    gc.set_threshold(100_000, 20, 100)  # as `jacaros lsp` does
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder).resolve() / "robot.asl"
        (path.parent / "p.jcm").write_text(_PROJECT)
        text = program()
        path.write_text(text)
        projects = Projects([path.parent])
        found = projects.update([path], {path: text})
        assert not any(found.values()), found
        print("diagnostics:", timed(lambda number: projects.update([path], {path: f"{text}// {number}\n"})))
        print("names:", timed(lambda number: _indexed(projects, path, f"{text}// {number}\n")))
        (unit,) = projects.units_of(path)
        assert unit.index is not None
        index, edited = unit.index, SourceFile(unit.name_of(path), f"{text}+!x : visited(room_1, N) <- !vis")
        end = Position(LINES + 1, len(edited.lines[-1]) + 1)
        assert completions(index, edited, end)
        print("completion:", timed(lambda _: completions(index, edited, end)))
        if edits:
            _measure_memory(edits)


def _indexed(projects: Projects, path: Path, text: str) -> None:
    projects.update([path], {path: text})
    projects.index({path: text})


def _measure_memory(edits: int) -> None:
    """Edit a small project with an artifact in Python, a mapping and a program."""
    with tempfile.TemporaryDirectory() as folder:
        base = Path(folder).resolve()
        (base / "artifacts.py").write_text(
            "from jacaros.artifacts import Artifact, operation\n\n\nclass Lamp(Artifact):\n"
            "    @operation\n    def light(self, colour: str) -> None: ...\n"
        )
        (base / "wheels.yaml").write_text(
            "operations:\n  stop:\n    publish: /cmd_vel\n    type: geometry_msgs/msg/Twist\n"
        )
        project = "mas p { agent a : a.asl workspace w { artifact l: Lamp() artifact m: wheels.yaml } }"
        (base / "p.jcm").write_text(project)
        path = base / "a.asl"
        projects = Projects([base])
        sizes = []
        for number in range(edits + 1):
            _indexed(projects, path, f"!s. +!s <- light({number}); stop; !go_{number}. +!go_{number}.")
            if number % max(1, edits // 10) == 0:
                sizes.append(memory())
        told = ", ".join(f"{size:.1f}" for size in sizes)
        print(f"memory over {edits} edits: {told} MB")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--edits", type=int, default=10_000)
    main(parser.parse_args().edits)
