"""What must hold for the repository as a whole: one version, no names of other places, nothing untested."""

import ast
import re
import tomllib
from importlib import metadata
from pathlib import Path
from typing import Any
from urllib.parse import urlparse
from xml.etree import ElementTree

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from packaging.version import Version
from phrases import tracked
from ruamel.yaml import YAML

import jacaros

ROOT = Path(__file__).parents[2]

FOREIGN = tuple(
    # Written in pieces, so that this file does not hold them itself.
    "".join(pieces)
    for pieces in (
        ("/", "work/"),
        ("/", "tmp/bash_jobs"),
        ("files.python", "hosted"),
        ("py", "pi.org"),
        ("deb.", "debian.org"),
        ("arti", "factory"),
        ("index", "-url"),
    )
)
"""Paths of a workplace, package hosts, settings of an index: a clone must work anywhere."""

HOSTS = {
    "127.0.0.1",
    "localhost",
    "zenoh.io",
    "github.com",  # the repository itself, see REPOSITORY
    "jacaros.github.io",  # the documentation as a site
    "json-schema.org",  # the name of its dialect
    "json.schemastore.org",  # the name of its schema
    "keepachangelog.com",
    "raw.githubusercontent.com",  # the names of our schemas
    "semver.org",
    "www.apache.org",
    "www.eprosima.com",  # the name of an XML language
    "www.w3.org",
}
"""Hosts that an address in the repository may name."""


REPOSITORY = "https://github.com/jacaros/jacaros"


def texts() -> list[tuple[str, str]]:
    """Every text file, with its path."""
    found = []
    for path in tracked():
        data = path.read_bytes()
        if b"\0" not in data:
            found.append((str(path.relative_to(ROOT)), data.decode("utf-8")))
    return found


def test_no_file_names_a_workplace_or_a_package_host() -> None:
    hits = [(path, word) for path, text in texts() for word in FOREIGN if word in text]
    assert hits == []


def test_addresses_use_known_hosts_only() -> None:
    strange = {
        (path, host)
        for path, text in texts()
        for address in re.findall(r"\b(?:https?|wss?|git|ssh)://[^\s\"'<>)\]}`,;]+", text)
        if (host := urlparse(address.rstrip(".:")).hostname or "") not in HOSTS
        and not re.fullmatch(r"[\w.-]+\.(example|invalid|test|local)", host)
        and "{" not in address
    }
    assert strange == set()


def test_addresses_at_github_are_those_of_the_project() -> None:
    strange = {
        (path, address)
        for path, text in texts()
        for address in re.findall(r"https?://github\.com[^\s\"'<>)\]}`,;]*", text)
        if not address.startswith(REPOSITORY)
    }
    assert strange == set()


def project() -> dict[str, Any]:
    """The table ``project`` of pyproject.toml."""
    table: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    return table


def pinned() -> dict[str, str]:
    """Versions in constraints.txt, by canonical name."""
    lines = (ROOT / "constraints.txt").read_text().splitlines()
    return dict(line.split("==") for line in lines if not line.startswith("#"))


def test_constraints_satisfy_what_the_project_requires() -> None:
    versions = pinned()
    extras = project()["optional-dependencies"].values()
    for text in [*project()["dependencies"], *(each for extra in extras for each in extra)]:
        wanted = Requirement(text)
        assert wanted.specifier.contains(versions[canonicalize_name(wanted.name)]), text


def test_constraints_hold_all_that_the_base_install_brings_along() -> None:
    versions, waiting, seen = pinned(), [Requirement(text) for text in project()["dependencies"]], set()
    while waiting:
        name = canonicalize_name(waiting.pop().name)
        if name not in seen:
            seen.add(name)
            further = map(Requirement, metadata.requires(name) or ())
            waiting += [
                each for each in further if each.marker is None or each.marker.evaluate({"extra": ""})
            ]
    assert {name for name in seen if name not in versions} == set()
    assert all(canonicalize_name(name) == name and Version(version) for name, version in versions.items())


def test_the_base_install_has_neither_numpy_nor_rosbags() -> None:
    assert {Requirement(text).name for text in project()["dependencies"]} == {
        "click",
        "msgspec",
        "rich",
        "ruamel.yaml",
        "websockets",
    }


def test_the_citation_has_what_the_format_requires() -> None:
    cited = YAML(typ="safe").load((ROOT / "CITATION.cff").read_text())
    assert cited["cff-version"] == "1.2.0"
    assert cited.keys() >= {"message", "title", "authors", "type", "license", "repository-code", "abstract"}
    assert cited["version"] == jacaros.__version__
    assert re.fullmatch(r"\d{4}-\d\d-\d\d", cited["date-released"])
    assert [reference["type"] for reference in cited["references"]][:2] == ["thesis", "conference-paper"]
    for person in (cited, *cited["references"]):
        assert person["title"]
        assert all("name" in author or "family-names" in author for author in person["authors"])


def test_there_is_one_version() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    package = ElementTree.parse(ROOT / "package.xml").getroot()
    assert project["version"] == jacaros.__version__ == package.findtext("version")
    assert f"## [{jacaros.__version__}]" in (ROOT / "CHANGELOG.md").read_text()


def test_the_licence_is_apache_2() -> None:
    text = (ROOT / "LICENSE").read_text()
    assert text.lstrip().startswith("Apache License\n")
    assert "TERMS AND CONDITIONS FOR USE, REPRODUCTION, AND DISTRIBUTION" in text
    assert "END OF TERMS AND CONDITIONS" in text


def test_the_suite_runs_every_folder_of_tests() -> None:
    suite = (ROOT / "tools" / "test_all.py").read_text()
    folders = {path.relative_to(ROOT / "tests").parts[0] for path in (ROOT / "tests").rglob("test_*.py")}
    left_out = [folder for folder in sorted(folders) if f'"tests/{folder}"' not in suite]
    assert left_out == []


def test_names_of_test_files_are_unique() -> None:
    """Otherwise pytest refuses to collect the second one."""
    names = [path.name for path in (ROOT / "tests").rglob("test_*.py")]
    assert sorted(name for name in set(names) if names.count(name) > 1) == []


def test_contributing_stays_short() -> None:
    assert len((ROOT / "CONTRIBUTING.md").read_text().splitlines()) <= 150


def test_the_programs_of_the_suite_can_be_run() -> None:
    programs = [ROOT / ".ci" / "run", *sorted((ROOT / "tools").glob("*.sh"))]
    assert [path.name for path in programs if not path.stat().st_mode & 0o111] == []
    assert [path.name for path in programs if not path.read_text().startswith("#!/")] == []


def test_the_mind_says_what_its_values_are() -> None:
    files = list((ROOT / "src" / "jacaros" / "agents" / "mind").rglob("*.py"))
    texts = [file.read_text(encoding="utf-8") for file in files]
    names = [node for text in texts for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Name)]
    untyped = sum(node.id == "Any" for node in names)
    assert 1000 * untyped / sum(text.count("\n") for text in texts) <= 10
