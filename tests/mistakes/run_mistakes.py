"""Run the mistakes that `jacaros check` does not report: ``python tests/mistakes/run_mistakes.py [EVERY]``.

Each run takes ten seconds of the virtual clock, and at most a minute. What it logs must name the line of the mistake, or
what the mistake has changed, in a line that the run of the right program does not log. EVERY: run only each second, ...
mistake of the table.
"""

import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parent / "docs")]

from corpus import BY_NAME, read, with_mistake, written  # noqa: E402
from measuring import names_of, table, unreported  # noqa: E402
from mutations import Mistake  # noqa: E402
from programs import Program  # noqa: E402

SECONDS, PATIENCE = 10, 60
_WORD = re.compile(r"[A-Za-z_]\w*")


def silent(mistakes: list[Mistake], folder: Path) -> Iterator[Mistake]:
    """Yield the mistakes of which a run says nothing."""
    right: dict[str, set[str]] = {}
    for number, each in enumerate(mistakes):
        program = BY_NAME[each.program]
        with written(program, folder / str(number)) as files:
            if each.program not in right:
                right[each.program] = set(_logged(program))
            text, line = with_mistake(files[each.file], each)
            Path(each.file).write_text(text, encoding="utf-8")
            new = [said for said in _logged(program) if said not in right[each.program]]
            place, names = f"{Path(each.file).name}:{line}", names_of(each, files)
            if not any(place in said or names & set(_WORD.findall(said)) for said in new):
                yield each


def _logged(program: Program) -> list[str]:
    """Return the lines that a run of the program in the current folder logs."""
    options = [word for mapping in program.mappings for word in ("--mapping", mapping)]
    options += ["--world", program.world] if program.world else []
    command = [sys.executable, "-m", "jacaros", "run", program.entry, *options]
    try:
        ended = subprocess.run(
            [*command, "--clock", "fast", "--seed", "0", "--for", str(SECONDS)],
            capture_output=True,
            stdin=subprocess.DEVNULL,
            text=True,
            timeout=PATIENCE,
            check=False,
        )
        return ended.stderr.splitlines()
    except subprocess.TimeoutExpired as late:
        return (late.stderr or b"").decode().splitlines()


def main(every: int) -> None:
    """Print what neither check nor a run reports."""
    with tempfile.TemporaryDirectory() as name:
        mistakes = read()[::every]
        missed = unreported(mistakes, Path(name) / "checked")
        print(table(mistakes, missed), flush=True)
        print("\nby check or a run:")
        print(table(mistakes, list(silent(missed, Path(name)))))


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 1)
