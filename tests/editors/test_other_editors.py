"""The lines of the page for other editors are right: Neovim runs them, and shows what the language server finds."""

import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[2] / "docs" / "how-to" / "edit_in_your_editor.md"

OLD_NEOVIM = """
vim.g.do_filetype_lua = 1
vim.lsp.start = vim.lsp.start or function(config)
  vim.lsp.buf_attach_client(0, vim.lsp.start_client(config))
end
"""
"""The one function that Debian 12's Neovim 0.7 lacks."""
PROBE = """
vim.wait(120000, function() return #vim.diagnostic.get(0) > 0 end)
for _, found in ipairs(vim.diagnostic.get(0)) do io.stdout:write(found.lnum + 1, ": ", found.message, "\\n") end
vim.cmd("qa!")
"""


def block(heading: str) -> str:
    """Return the first block of code below a heading of the page."""
    return PAGE.read_text(encoding="utf-8").partition(f"## {heading}\n")[2].split("```")[1].partition("\n")[2]


@pytest.fixture
def environment(tmp_path: Path) -> dict[str, str]:
    """Variables with which `jacaros` is this one."""
    command = tmp_path / "bin" / "jacaros"
    command.parent.mkdir()
    command.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m jacaros "$@"\n', encoding="utf-8")
    command.chmod(0o755)
    path = f"{command.parent}{os.pathsep}{os.environ['PATH']}"
    return {**os.environ, "PATH": path, "HOME": str(tmp_path), "XDG_CONFIG_HOME": str(tmp_path)}


def test_neovim_shows_mistakes_with_their_fixes(tmp_path: Path, environment: dict[str, str]) -> None:
    neovim = shutil.which("nvim")
    assert neovim is not None
    start, probe, program = tmp_path / "init.lua", tmp_path / "probe.lua", tmp_path / "robot.asl"
    start.write_text(OLD_NEOVIM + block("Neovim"), encoding="utf-8")
    probe.write_text(PROBE, encoding="utf-8")
    program.write_text('!start.\n+!start <- .prnt("x").\n', encoding="utf-8")
    command = [neovim, "--headless", "-u", str(start), str(program), f"+luafile {probe}"]
    done = subprocess.run(
        command, check=True, env=environment, cwd=tmp_path, capture_output=True, text=True, timeout=180
    )
    assert "2: unknown internal action `.prnt`" in done.stdout
    assert "did you mean `.print`?" in done.stdout


def test_the_lines_for_helix_name_the_command() -> None:
    configuration = tomllib.loads(block("Helix"))
    server = configuration["language-server"]["jacaros"]
    assert [server["command"], *server["args"]] == ["jacaros", "lsp"]
    assert configuration["language"][0]["language-servers"] == ["jacaros"]
