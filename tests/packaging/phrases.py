"""Phrases that our texts avoid, and where they occur.

Run it on files or folders to list them: ``python tests/packaging/phrases.py docs src/jacaros/robots/world``.
"""

import io
import re
import subprocess
import sys
import tokenize
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]

INSTEAD = {
    r"(?:is|are|was|were|be|been|being|gets?) (?:\w+ )?told": "log, warn, report, raise, notify: name the actor",
    r"(?<!there[ \n])(?:is|are|was|were) no"
    r"(?! longer\b| more\b| matter\b| (?:fast|slow|bett|great|small|larg|fin)er\b|[.,:;)`\'\"])": (
        "is not a, does not exist, unknown"
    ),
    r"(?-i:(?:is|are|was|were) none)": "is not one, does not exist, is invalid",
    r"that there (?:is|are) not": "unknown",
    r"(?<!/)(?:whoever|nobody|somebody|everybody)(?![\"'`/(])": "you, the caller, no agent, every agent",
    r"who(?:ever)? wants": "to …",
    r"(?:no|not any|any) more(?! than\b| \w+s\b)": "no longer, not again",
    r"needs not": "need not",
    r"can not": "cannot",
    r"of (?:its|their) own accord": "automatically",
    r"so (?:it|that) is(?=[.,;:])": "cut it",
    r"(?:goes|went|gets|got) on(?= (?:as|with|from|to|where|after|until|without|driving|running)\b|[.,;:)])": "continue",
    r"passed over": "skipped",
    r"given up(?= (?:after|by|when|as)\b)": "dropped, abandoned",
    r"(?:is|are|was|were) to be had": "is available",
    r"(?:as it were|so to speak|after all)": "cut it",
    r"(?:carried|carries|carry) out": "run, execute",
    r"(?:place and cure|hint:|cures?)": "location and suggested fix; help:",
    r"one after the other": "in turn, one at a time",
    r"(?:comes?|came) to (?:its|an|their) end": "end",
    r"what (?:came|comes) of (?:it|them)": "the outcome",
    r"(?:hand|hands|handed) (?:in|over|on)": "pass, transfer, forward",
    r"it is (?:said|taken) (?:that|for)": "name the actor",
}
"""Patterns of phrases, and what to write instead."""

PHRASES = re.compile(
    "|".join(rf"(?P<p{n}>\b{pattern}(?!\w))" for n, pattern in enumerate(INSTEAD)), re.IGNORECASE
)

TEXTS = {".md", ".py", ".asl", ".jcm", ".mas2j", ".yaml", ".toml", ".js", ".html", ".css", ".sh", ".cff"}

RECORDED = ("tests/conformance",)
"""Folders whose texts were recorded elsewhere, and are kept as they were."""


class Finding(NamedTuple):
    """A phrase in a text."""

    path: str
    line: int
    phrase: str
    instead: str


def findings(paths: Iterable[Path]) -> Iterator[Finding]:
    """The phrases in these files."""
    for path in paths:
        name = path.relative_to(ROOT).as_posix()
        if (
            path.suffix not in TEXTS
            or name.startswith(RECORDED)
            or path.name in (Path(__file__).name, "test_english.py")
        ):
            continue
        source = path.read_text(encoding="utf-8")
        for line, text in prose(source) if path.suffix == ".py" else [(1, source)]:
            for match in PHRASES.finditer(text):
                instead = list(INSTEAD.values())[int(str(match.lastgroup)[1:])]
                yield Finding(name, line + text.count("\n", 0, match.start()), match.group(), instead)


def prose(source: str) -> Iterator[tuple[int, str]]:
    """The strings, comments and names of tests of a Python source, with their first lines."""
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type in TOKENS_OF_PROSE:
            yield token.start[0], token.string
        elif token.type == tokenize.NAME and token.string.startswith("test_"):
            yield token.start[0], token.string.replace("_", " ")


TOKENS_OF_PROSE = {tokenize.STRING, tokenize.COMMENT, getattr(tokenize, "FSTRING_MIDDLE", tokenize.STRING)}


def tracked(under: Iterable[str] = ()) -> list[Path]:
    """The files in these folders, by default in all, that git tracks or does not ignore."""
    git = "git -c safe.directory=* ls-files --cached --others --exclude-standard -z --"
    command = [*git.split(), *under]
    listing = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return [ROOT / name for name in listing.split("\0") if name and (ROOT / name).is_file()]


if __name__ == "__main__":
    for finding in findings(tracked(sys.argv[1:])):
        print(f"{finding.path}:{finding.line}: {finding.phrase!r}; instead: {finding.instead}")
