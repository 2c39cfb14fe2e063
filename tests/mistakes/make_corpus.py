"""Write the table of mistakes: ``python tests/mistakes/make_corpus.py``, after the programs have changed.

The choice depends on the texts only: kinds take turns, within a kind programs do, and their order and that of the places
is that of a checksum. A kind with few places leaves the rest to the others.
"""

import sys
import zlib
from collections import defaultdict
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parent / "docs")]

from corpus import CORPUS, EQUAL, write  # noqa: E402
from mutations import Mistake, mistakes  # noqa: E402
from programs import PROGRAMS  # noqa: E402

MOST = 150


def chosen(found: list[Mistake]) -> list[Mistake]:
    """Return `MOST` mistakes, balanced over kinds and programs."""
    kinds: dict[str, list[Mistake]] = defaultdict(list)
    for each in found:
        kinds[each.kind].append(each)
    queues = {kind: _in_turns(each) for kind, each in sorted(kinds.items())}
    picked: dict[tuple[str, str, int], Mistake] = {}
    while len(picked) < MOST and any(queues.values()):
        for queue in queues.values():
            # No line has two mistakes: the table shows more of the programs.
            while queue and (place := (queue[0].program, queue[0].file, queue[0].line)) in picked:
                queue.pop(0)
            if queue and len(picked) < MOST:
                picked[place] = queue.pop(0)
    return sorted(picked.values(), key=lambda each: (each.kind, each.program, each.file, each.line))


def _in_turns(found: list[Mistake]) -> list[Mistake]:
    places: dict[str, list[Mistake]] = defaultdict(list)
    for each in sorted(found, key=_checksum):
        places[each.program].append(each)
    programs = sorted(places, key=lambda name: zlib.crc32(f"{found[0].kind} {name}".encode()))
    longest = max(map(len, places.values()))
    return [places[name][at] for at in range(longest) for name in programs if at < len(places[name])]


def _checksum(each: Mistake) -> int:
    return zlib.crc32(f"{each.kind} {each.program} {each.before} {each.after}".encode())


def main() -> None:
    """Write both tables."""
    found = [each for program in PROGRAMS for each in mistakes(program)]
    write(CORPUS, chosen([each for each in found if not each.equal]))
    write(EQUAL, chosen([each for each in found if each.equal]))


if __name__ == "__main__":
    main()
