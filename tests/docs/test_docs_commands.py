"""Commands that the documentation only shows (setup, real robots) name existing things."""

import re
import shlex
import subprocess
from pathlib import Path

import click
import pytest
from pages import PAGES, ROOT, blocks, name_of

from jacaros.runtime.cli.main import jacaros
from jacaros.runtime.cli.ros_arguments import as_options, has_ros_arguments


def shell_lines() -> list[tuple[str, str]]:
    """Commands of the ``sh`` and ``console`` blocks, each with its place."""
    found = []
    for page in PAGES:
        for block in blocks(page):
            if block.language in ("sh", "console"):
                text = re.sub(r"\\\n\s*", "", block.text)
                for line in text.splitlines():
                    command = line.removeprefix("$ ") if block.language == "console" else line
                    if block.language == "sh" or line.startswith("$ "):
                        found.append((f"{name_of(page)}:{block.line}", command.partition("  #")[0].strip()))
    return found


LINES = shell_lines()


def words_behind(program: str) -> list[tuple[str, list[str]]]:
    """The arguments of the calls of *program*, each with its place."""
    found = []
    for where, line in LINES:
        for command in re.split(r"[;|&]+", line):
            words = [w for w in shlex.split(command, comments=True) if not re.fullmatch(r"[A-Z_0-9]+=.*", w)]
            if words and (words[0] == program or words[0].endswith(f"/{program}")):
                found.append((where, words[1:]))
    return found


@pytest.mark.parametrize(("where", "words"), words_behind("jacaros"))
def test_commands_on_pages_are_valid(where: str, words: list[str]) -> None:
    words = [word for word in words if ">" not in word]
    if has_ros_arguments(words):
        words = as_options(words, pytest.fail)
    context = click.Context(jacaros, info_name="jacaros")
    name, command, rest = jacaros.resolve_command(context, words)
    assert command is not None
    try:
        command.make_context(str(name), list(rest), parent=context)
    except click.exceptions.Exit:
        pass
    except click.UsageError as wrong:
        pytest.fail(f"{where}: {wrong.format_message()}")


@pytest.mark.parametrize(("where", "words"), words_behind("make"))
def test_make_targets_on_pages_exist(where: str, words: list[str]) -> None:
    targets = [word for word in words if "=" not in word]
    done = subprocess.run(["make", "-n", *targets], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{where}: {done.stderr}"


@pytest.mark.parametrize(("where", "line"), LINES)
def test_tools_named_on_pages_exist(where: str, line: str) -> None:
    for tool in re.findall(r"(?<![\w/])tools/[\w.]+", line):
        assert (ROOT / tool).is_file(), f"{where}: {tool} does not exist"


def test_the_pages_have_commands() -> None:
    assert len(LINES) > 20
    assert isinstance(ROOT, Path)
