"""Completion in the shells that docs/how-to/start_a_project.md shows: what Tab offers after `jacaros ...`."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

COMPLETED = {
    "bash": """
        eval "$(_JACAROS_COMPLETE=bash_source jacaros)"
        COMP_WORDS=(jacaros "$@"); COMP_CWORD=$#
        _jacaros_completion jacaros
        printf '%s\\n' "${COMPREPLY[@]}"
    """,
    # The function of zsh's completion that lists what is offered works at a prompt only.
    "zsh": """
        compdef() { }
        _describe() { print -l -- "${completions_with_descriptions[@]%%:*}" }
        compadd() { print -l -- "${completions[@]}" }
        eval "$(_JACAROS_COMPLETE=zsh_source jacaros)"
        words=(jacaros "$@"); CURRENT=$(($# + 1))
        _jacaros_completion
    """,
    "fish": """
        _JACAROS_COMPLETE=fish_source jacaros | source
        complete --do-complete "jacaros $argv" | string replace -r '\\t.*' ''
    """,
}
"""Programs that print what each shell offers for the words given as arguments, one a line."""


@pytest.fixture(params=COMPLETED)
def shell(request: pytest.FixtureRequest) -> str:
    """A shell of this machine."""
    name: str = request.param
    if shutil.which(name) is None:
        pytest.skip(f"{name} is not installed")
    return name


def offered(shell: str, folder: Path, *words: str) -> list[str]:
    """Return what a shell offers for the last of the words."""
    done = subprocess.run(
        [shell, "-c", COMPLETED[shell], *([] if shell == "fish" else [shell]), *words],
        cwd=folder,
        env={
            **os.environ,
            "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
            "HOME": str(folder),
        },
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.stderr == ""
    return sorted(done.stdout.split())


def test_a_command_is_completed(shell: str, tmp_path: Path) -> None:
    assert offered(shell, tmp_path, "fl") == ["fleet"]
    assert offered(shell, tmp_path, "ver") == ["version"]


def test_an_option_is_completed(shell: str, tmp_path: Path) -> None:
    assert offered(shell, tmp_path, "run", "--se") == ["--seed", "--serve"]


def test_a_value_is_completed(shell: str, tmp_path: Path) -> None:
    assert offered(shell, tmp_path, "new", "--template", "r") == ["robot", "ros2-package"]
