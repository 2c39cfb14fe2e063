"""Keys and values of YAML files, by their declarations."""

from pathlib import Path

import pytest
from edited import opened

from jacaros.editors.symbols.yaml_keys import yaml_completions, yaml_hover
from jacaros.editors.symbols.yaml_places import place_in


def proposed(marked: str) -> set[str]:
    return {each.label for each in yaml_completions(*opened(marked, "file.yaml"))}


@pytest.mark.parametrize(
    ("marked", "has", "lacks"),
    [
        ("name: x\n‸", "robots", "name"),
        ("name: x\nro‸\nrobots: []", "rooms", "robots"),
        ("robots:\n  - name: a\n    ‸", "battery", "robots"),
        ("robots:\n- name: a\n  bat‸", "battery", "name"),
        ("robots:\n  - name: a\n    battery: {level: 1, ‸}", "drain_per_metre", "level"),
        ("robots:\n  - name: a\n    battery:\n      ‸\n      level: 3", "drain_per_metre", "level"),
        ("docks:\n  - {name: d, x: 1,\n     ‸", "yaw_degrees", "x"),
        ("border: ‸", "walls", "robots"),
        ("docks:\n  - name: d\nro‸", "rooms", "radius"),
        ("faults:\n  wet: {kind: ‸", "wheel_slip", "share"),
        ("faults:\n  wet: {kind: wheel_slip, ‸", "share", "wheel"),
        ("faults:\n  wet:\n    kind: blocked_wheel\n    wheel: ‸", "left", "kind"),
        ("faults:\n  wet:\n    wheel: left\n    kind: ‸", "blocked_wheel", "wheel_slip"),
        ("operations:\n  go:\n    ‸", "publish", "operations"),
        ("operations:\n  go:\n    publish: x\n    ‸", "rate", "request"),
        ("operations:\n  go:\n    - publish: x\n      ‸", "rate", "request"),
        ("properties:\n  p:\n    topic: /x\n    qos: ‸", "latched", "reliability"),
        ("properties:\n  p:\n    topic: /x\n    qos: {durability: ‸", "volatile", "latched"),
        ("properties:\n  p:\n    topic: /x\n    fields: [{path: x, unit: de‸", "degrees", "metres"),
        ("operations:\n  go:\n    wrong: x\n    ‸", "publish", "wrong"),
        (
            "properties:\n  p:\n    topic: /x  # a: b\n    fields:\n      - {path: x, ‸}",
            "unit",
            "path",
        ),
    ],
)
def test_keys_and_values_are_those_that_are_declared(marked: str, has: str, lacks: str) -> None:
    found = proposed(marked)
    assert has in found
    assert lacks not in found


def test_a_key_ends_in_a_colon_and_says_what_it_means() -> None:
    found = yaml_completions(*opened("docks:\n  - name: d\n    rad‸", "file.yaml"))
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
        ("properties:\n  p:\n    topic: /x\n    expi‸re: 3", "the property is removed"),
    ],
)
def test_hover_says_what_a_key_means(marked: str, told: str) -> None:
    found = yaml_hover(*opened(marked, "file.yaml"))
    assert found is not None
    assert told in found.text


def test_nothing_is_known_of_other_files() -> None:
    assert proposed("on: push\njobs:\n  ‸") == set()
    assert {"robots", "faults", "operations"} <= proposed("‸")


def test_unknown_keys_and_blanks_have_no_hover() -> None:
    assert yaml_hover(*opened("unkno‸wn: 1", "file.yaml")) is None
    assert yaml_hover(*opened("name: x\n‸", "file.yaml")) is None


def test_every_position_of_the_worlds_has_a_place() -> None:
    for path in sorted(Path(__file__).parents[3].glob("examples/*/*.yaml")):
        text = path.read_text(encoding="utf-8")
        for end in range(0, len(text), 7):
            assert isinstance(place_in(text[:end]).path, tuple)
