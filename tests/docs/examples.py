"""The examples of a page that have an expected output.

A block ``output`` shows what the file of the block before it prints when it is run with ``jacaros run FILE --clock fast
--until-idle``, character by character; a block ``errors`` what that run tells besides. Without such a block nothing is
told. Files that an example needs (other agents, an included file) stand before it on its page, under their names::

    ```agentspeak demo.asl
    !start.
    +!start <- .print(hello).
    ```
    ```output
    [demo] hello
    ```
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from pages import Block, blocks, is_file

from jacaros.testing.run import RunResult, run_project

SHOWN = ("output", "errors")


@dataclass(slots=True)
class Example:
    """A program with its expected output.

    Attributes:
        file: the name of the file that is run.
        line: where the block of that file begins.
        files: all files that stand on the page up to there.
        output: what the agents are said to print.
        errors: other expected output.
    """

    file: str
    line: int
    files: dict[str, str]
    output: str = ""
    errors: str = ""
    shown: set[str] = field(default_factory=set)


def examples(page: Path) -> Iterator[Example]:
    """The examples of a page."""
    files: dict[str, str] = {}
    last: Block | None = None
    example: Example | None = None
    for block in blocks(page):
        if block.language in SHOWN:
            assert last is not None, f"{page.name}:{block.line}: nothing stands before this {block.language}"
            if example is None:
                example = Example(last.purpose, last.line, dict(files))
            assert block.language not in example.shown, f"{page.name}:{block.line}: a second {block.language}"
            example.shown.add(block.language)
            setattr(example, block.language, block.text.rstrip("\n"))
            continue
        if example is not None:
            yield example
        example = None
        last = block if is_file(block) else None
        if is_file(block):
            files[block.purpose] = block.text
    if example is not None:
        yield example


def run(example: Example, folder: Path) -> RunResult:
    """Run an example in the current folder, which must be *folder*."""
    for name, text in example.files.items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    return run_project(Path(example.file), until_idle=True)


def shown(result: RunResult) -> tuple[str, str]:
    """Return the output and the log of a run, as pages show it."""
    return _text(result.lines), _text(result.errors)


def _text(lines: list[str]) -> str:
    return "\n".join(line.rstrip() for text in lines for line in text.split("\n"))
