"""Every program of the documentation runs, and prints what the page says."""

import sys
from pathlib import Path

import pytest
from examples import SHOWN, examples
from following import Reader
from pages import PAGES, ROOT, blocks, is_file, name_of

LANGUAGES = {
    "agentspeak",
    "console",
    "diff",
    "ebnf",
    "elisp",
    "html",
    "java",
    "jcm",
    "json",
    "lua",
    "mas2j",
    "python",
    "sh",
    "text",
    "toml",
    "xml",
    "yaml",
    *SHOWN,
}

RUN = [page for page in PAGES if any(block.language == "console" for block in blocks(page))]


@pytest.mark.skipif(sys.platform == "win32", reason="the commands of pages are for a POSIX shell")
@pytest.mark.parametrize("page", RUN, ids=name_of)
def test_the_commands_of_a_page_print_what_it_says(page: Path, tmp_path: Path) -> None:
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    (tmp_path / "runs").mkdir()
    with Reader(tmp_path) as reader:
        reader.follow(page)


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_every_block_of_a_page_has_a_known_purpose(page: Path) -> None:
    """A program that is neither run nor an excerpt could be wrong without being noticed."""
    for block in blocks(page):
        where = f"{name_of(page)}:{block.line}"
        assert block.language in LANGUAGES, f"{where}: language {block.language!r}"
        if block.language in ("agentspeak", "jcm", "mas2j", "python", "yaml"):
            assert block.purpose, f"{where}: name the file, or what it is an excerpt of"


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_files_of_a_page_are_used_by_its_commands(page: Path) -> None:
    found = list(blocks(page))
    files = [block for block in found if is_file(block)]
    text = " ".join(block.text for block in found if block.language == "console")
    programs = " ".join(block.text for block in files)
    run = {example.line for example in examples(page)}
    for block in files:
        stem = Path(block.purpose).stem
        used = block.line in run or stem in text or stem in programs or stem == "artifacts"
        assert used, f"{name_of(page)}:{block.line}: nothing runs {block.purpose}"


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_excerpts_appear_in_their_files(page: Path) -> None:
    for block in blocks(page):
        if not block.purpose.startswith("excerpt "):
            continue
        path = ROOT / block.purpose.removeprefix("excerpt ")
        assert path.is_file(), f"{name_of(page)}:{block.line}: there is no file {path}"
        source = [line.strip() for line in path.read_text(encoding="utf-8").splitlines()]
        place = 0
        for line in (line.strip() for line in block.text.splitlines()):
            if line in ("", "...", "# ..."):
                continue
            where = f"{name_of(page)}:{block.line}: {path.name} lacks a line (or has it in another order)"
            assert line in source[place:], f"{where}\n{line}"
            place = source.index(line, place) + 1
