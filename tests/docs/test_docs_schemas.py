"""The JSON Schemas accept the files that come with the package, reject misspelt keys, and are current."""

import subprocess
import sys
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator
from ruamel.yaml import YAML

from jacaros.editors import schemas
from jacaros.robots.mapping.file import is_mapping
from jacaros.robots.streams import OPERATORS
from jacaros.robots.world.files.faults import is_fault_file
from jacaros.robots.world.files.world import is_world

ROOT = Path(__file__).parents[2]
SCHEMAS = ROOT / "docs" / "reference" / "schemas"
KINDS = {"world": is_world, "faults": is_fault_file, "mapping": is_mapping}
FILES = sorted(
    each for folder in ("src", "examples", "experiment") for each in (ROOT / folder).rglob("*.yaml")
)
YAML_FILES = [(kind, each) for each in FILES for kind, is_kind in KINDS.items() if is_kind(each)]


def mistakes(kind: str, text: str) -> list[str]:
    schema = YAML(typ="safe").load(SCHEMAS / f"{kind}.json")
    found = Draft202012Validator(schema).iter_errors(YAML(typ="safe").load(text))
    return [f"{each.json_path}: {each.message}" for each in found]


@pytest.mark.parametrize(("kind", "file"), YAML_FILES, ids=lambda each: getattr(each, "stem", each))
def test_a_schema_accepts_the_files_of_the_package_and_the_examples(kind: str, file: Path) -> None:
    text = file.read_text(encoding="utf-8")
    if "image:" not in text:  # the header of a map
        assert mistakes(kind, text) == []


@pytest.mark.parametrize(
    ("kind", "text", "told"),
    [
        ("world", "robots: [{name: r, radios: 0.2}]", "radios"),
        ("world", "robots: [{name: r, laser: {beams_per_turn: 2}}]", "2 is less than the minimum of 4"),
        ("world", "size: [4, 4]", "'robots' is a required property"),
        ("faults", "faults: {f: {kind: dead, topik: /scan}}", "not valid"),
        ("mapping", "properties: {odom: {topic: odom, fields: [{path: x, rond: 2}]}}", "not valid"),
        ("mapping", "propertys: {}", "propertys"),
        ("mapping", "operations: {go: {publish: cmd_vel, retry: 3}}", "not valid"),
    ],
)
def test_a_schema_marks_a_mistake(kind: str, text: str, told: str) -> None:
    assert any(told in each for each in mistakes(kind, text))


def test_the_schemas_are_current(tmp_path: Path) -> None:
    subprocess.run([sys.executable, ROOT / "tools" / "make_schemas.py", tmp_path], check=True)
    for kind in KINDS:
        written, made = SCHEMAS / f"{kind}.json", tmp_path / f"{kind}.json"
        assert written.read_text(encoding="utf-8") == made.read_text(encoding="utf-8"), "run `make reference`"


def test_every_key_of_a_mapping_says_what_it_means() -> None:
    operators = {word for name, each in OPERATORS.items() for word in (name, *each.required, *each.optional)}
    silent = set()
    stack = [schemas.mappings()]
    while stack:
        each = stack.pop()
        inner = each.get("properties", {})
        if "artifacts" not in inner and "properties" not in inner:
            silent |= {
                key for key, value in inner.items() if "description" not in value and "enum" not in value
            }
        stack += [value for value in (*inner.values(), *each.get("anyOf", ())) if isinstance(value, dict)]
        stack += [each[key] for key in ("additionalProperties", "items") if isinstance(each.get(key), dict)]
    assert silent <= operators
