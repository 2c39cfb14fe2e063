"""Keys and values of YAML files, by schemas."""

import json
from pathlib import Path
from typing import Any

import pytest
from edited import opened

from jacaros.editors.symbols import yaml_completions, yaml_hover
from jacaros.editors.symbols.yaml_places import place_in

SCHEMAS = Path(__file__).parents[3] / "docs" / "reference" / "schemas"


def schema(kind: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((SCHEMAS / f"{kind}.json").read_text(encoding="utf-8"))
    return found


def proposed(kind: str, marked: str) -> set[str]:
    return {each.label for each in yaml_completions(schema(kind), *opened(marked, "file.yaml"))}


@pytest.mark.parametrize(
    ("kind", "marked", "has", "lacks"),
    [
        ("world", "name: x\n‸", "robots", "name"),
        ("world", "name: x\nro‸\nrobots: []", "rooms", "robots"),
        ("world", "robots:\n  - name: a\n    ‸", "battery", "robots"),
        ("world", "robots:\n- name: a\n  bat‸", "battery", "name"),
        ("world", "robots:\n  - name: a\n    battery: {level: 1, ‸}", "drain_per_metre", "level"),
        ("world", "robots:\n  - name: a\n    battery:\n      ‸\n      level: 3", "drain_per_metre", "level"),
        ("world", "docks:\n  - {name: d, x: 1,\n     ‸", "yaw_degrees", "x"),
        ("world", "border: ‸", "walls", "robots"),
        ("world", "docks:\n  - name: d\nro‸", "rooms", "radius"),
        ("faults", "faults:\n  wet: {kind: ‸", "wheel_slip", "share"),
        ("faults", "faults:\n  wet: {kind: wheel_slip, ‸", "share", "wheel"),
        ("faults", "faults:\n  wet:\n    kind: blocked_wheel\n    wheel: ‸", "left", "kind"),
        ("faults", "faults:\n  wet:\n    wheel: left\n    kind: ‸", "blocked_wheel", "wheel_slip"),
        ("mapping", "operations:\n  go:\n    ‸", "publish", "operations"),
        ("mapping", "operations:\n  go:\n    publish: x\n    ‸", "rate", "request"),
        ("mapping", "operations:\n  go:\n    - publish: x\n      ‸", "rate", "request"),
        ("mapping", "operations:\n  go:\n    wrong: x\n    ‸", "publish", "wrong"),
        (
            "mapping",
            "properties:\n  p:\n    topic: /x  # a: b\n    fields:\n      - {path: x, ‸}",
            "unit",
            "path",
        ),
    ],
)
def test_keys_and_values_are_those_of_the_schema(kind: str, marked: str, has: str, lacks: str) -> None:
    found = proposed(kind, marked)
    assert has in found
    assert lacks not in found


def test_a_key_ends_in_a_colon_and_says_what_it_means() -> None:
    found = yaml_completions(schema("world"), *opened("docks:\n  - name: d\n    rad‸", "file.yaml"))
    (radius,) = found
    assert radius.insert == "radius: "
    assert "m" in radius.detail
    assert radius.replaces[1:] == (3, 5, 3, 8)


@pytest.mark.parametrize(
    ("marked", "told"),
    [
        ("robots:\n  - battery: {le‸vel: 1}", "charge at the start"),
        ("robots:\n  - battery:\n      level‸: 1", "charge at the start"),
        ("bor‸der: walls", "`open`, `walls`"),
    ],
)
def test_hover_says_what_a_key_means(marked: str, told: str) -> None:
    found = yaml_hover(schema("world"), *opened(marked, "file.yaml"))
    assert found is not None
    assert told in found.text


def test_unknown_keys_and_blanks_have_no_hover() -> None:
    assert yaml_hover(schema("world"), *opened("unkno‸wn: 1", "file.yaml")) is None
    assert yaml_hover(schema("world"), *opened("name: x\n‸", "file.yaml")) is None


def test_every_position_of_the_worlds_has_a_place() -> None:
    for path in sorted(Path(__file__).parents[3].glob("examples/*/*.yaml")):
        text = path.read_text(encoding="utf-8")
        for end in range(0, len(text), 7):
            assert isinstance(place_in(text[:end]).path, tuple)
