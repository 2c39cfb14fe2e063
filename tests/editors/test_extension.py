"""The manifest of the VS Code extension agrees with its code, the language server, the debugger and the command line."""

import json
import re
from pathlib import Path
from typing import Any

import click
import pytest

from jacaros.editors.dap import opening
from jacaros.editors.lsp import colours, lenses
from jacaros.runtime.cli.main import jacaros

FOLDER = Path(__file__).parents[2] / "editors" / "vscode"
CODE = {path.name: path.read_text(encoding="utf-8") for path in FOLDER.glob("*.js")}


@pytest.fixture(scope="module")
def manifest() -> Any:
    return json.loads((FOLDER / "package.json").read_text(encoding="utf-8"))


def test_each_command_of_the_manifest_is_registered(manifest: Any) -> None:
    table = re.search(r"const COMMANDS = \{(.*?)\n\};", CODE["extension.js"], re.DOTALL)
    assert table is not None
    registered = set(re.findall(r"^  (\w+)[:,]", table[1], re.MULTILINE)) | {"restart"}
    shown = {each["command"].removeprefix("jacaros.") for each in manifest["contributes"]["commands"]}
    assert shown == registered


def test_the_lenses_of_the_server_call_commands_of_the_extension(manifest: Any) -> None:
    shown = {each["command"] for each in manifest["contributes"]["commands"]}
    assert {lenses.RUN, lenses.TEST, lenses.WHY} <= shown
    assert f'executeCommand("{lenses.EXPLAIN}"' in CODE["extension.js"]


def test_the_files_of_the_manifest_exist(manifest: Any) -> None:
    contributes = manifest["contributes"]
    paths = [each["path"] for kind in ("grammars", "snippets") for each in contributes[kind]]
    paths += [each["configuration"] for each in contributes["languages"]]
    assert [path for path in paths if not (FOLDER / path).is_file()] == []


def test_every_command_line_of_the_extension_exists(manifest: Any) -> None:
    tasks = manifest["contributes"]["taskDefinitions"][0]["properties"]["command"]["enum"]
    context = click.Context(jacaros)
    assert {*tasks, "lsp", "dap"} <= set(jacaros.list_commands(context))
    run = jacaros.get_command(context, "run")
    assert run is not None
    assert "--view-in-frame" in {option for each in run.params for option in each.opts}


def test_the_settings_of_the_debugger_are_those_that_it_reads(manifest: Any) -> None:
    attributes = manifest["contributes"]["debuggers"][0]["configurationAttributes"]["launch"]["properties"]
    assert set(opening._OPTIONS) <= set(attributes)
    examples = {"world": "house", "seed": 1, "clock": "fast", "mapping": ["a.yaml", "b.yaml"]}
    words = opening.command_line({"program": "robot.asl", **examples, "args": ["--until-idle"]})
    assert [word for word in words if not word.startswith("--")] == [
        *("robot.asl", "house", "1", "fast", "a.yaml", "b.yaml")
    ]


def test_the_kinds_of_words_that_have_a_colour_are_those_of_the_server(manifest: Any) -> None:
    scopes = manifest["contributes"]["semanticTokenScopes"][0]["scopes"]
    assert set(scopes) <= set(colours.LEGEND.token_types)


def test_snippets_have_distinct_prefixes() -> None:
    for path in (FOLDER / "snippets").glob("*.json"):
        prefixes = [each["prefix"] for each in json.loads(path.read_text(encoding="utf-8")).values()]
        assert len(prefixes) == len(set(prefixes))
