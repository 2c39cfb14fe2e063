"""The generated reference pages are up to date."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import msgspec
import pytest
from pages import ROOT

from jacaros.look.records.records import EVENTS
from jacaros.robots.registry import BUILT_IN
from jacaros.robots.world.data.ground_truth import FIELDS
from jacaros.robots.world.files.world import shipped_worlds
from jacaros.runtime.cli.main import COMMANDS

REFERENCE, STATIC = ROOT / "docs" / "reference", ROOT / "src" / "jacaros" / "look" / "page" / "static"


@pytest.fixture(scope="module")
def fresh(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("reference")
    subprocess.run([sys.executable, ROOT / "tools" / "make_reference.py", folder], check=True)
    return folder


@pytest.mark.parametrize(
    "page",
    ["cli.md", "artifacts.md", "world_keys.md", "recordings.md", "internal_actions/index.md", "schema.js"],
)
def test_a_generated_page_is_up_to_date(page: str, fresh: Path) -> None:
    kept = (STATIC if page == "schema.js" else REFERENCE) / page
    same = kept.read_text(encoding="utf-8") == (fresh / page).read_text(encoding="utf-8")
    assert same, f"{kept} is out of date: run `make reference`"


def test_the_schema_says_what_each_field_of_an_event_is() -> None:
    for kind, event in EVENTS.items():
        if kind not in FIELDS:
            described = set(re.findall(r"\w+", event.__doc__ or ""))
            assert {each.encode_name for each in msgspec.structs.fields(event)} <= described, kind


def test_every_command_and_artifact_is_described() -> None:
    cli = (REFERENCE / "cli.md").read_text(encoding="utf-8")
    assert [name for name in COMMANDS if f"## jacaros {name}\n" not in cli] == []
    artifacts = (REFERENCE / "artifacts.md").read_text(encoding="utf-8")
    assert [name for name in BUILT_IN if f"## {name}\n" not in artifacts] == []


def test_every_world_of_the_package_is_named() -> None:
    worlds = (REFERENCE / "worlds.md").read_text(encoding="utf-8")
    assert [name for name in shipped_worlds() if f"`{name}`" not in worlds] == []


def test_the_numbers_of_conformance_cases_are_right() -> None:
    expected = [
        path.read_text(encoding="utf-8") for path in (ROOT / "tests" / "conformance").rglob("*.expected")
    ]
    language = sum("# not recorded" not in text for text in expected)
    environment = len(list((ROOT / "tests" / "conformance_environment").rglob("expected")))
    page = (REFERENCE / "compatibility.md").read_text(encoding="utf-8")
    assert f"`tests/conformance` has {language} small programs" in page
    assert f"`tests/conformance_environment` has {environment} projects" in page
    assert f"All of {language} programs recorded on Jason" in (ROOT / "README.md").read_text(encoding="utf-8")


def test_every_dependency_is_weighed() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    wanted = [*project["dependencies"], *project["optional-dependencies"]["dev"]]
    names = [text.partition(">")[0] for text in wanted]
    page = (ROOT / "docs" / "dependencies.md").read_text(encoding="utf-8")
    assert [name for name in names if name not in page] == []
