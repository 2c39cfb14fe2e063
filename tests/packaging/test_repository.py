"""What must hold for the repository as a whole: one version, no names of other places, nothing untested."""

import ast
import re
import subprocess
import tomllib
from pathlib import Path
from urllib.parse import urlparse
from xml.etree import ElementTree

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
    "docs.oasis-open.org",  # the format SARIF
    "json.schemastore.org",  # the name of its schema
    "keepachangelog.com",
    "semver.org",
    "www.apache.org",
    "www.eprosima.com",  # the name of an XML language
    "www.w3.org",
}
"""Hosts that an address in the repository may name."""


def tracked() -> list[Path]:
    """Return the files under version control; all files without version control."""
    listing = subprocess.run(
        ["git", "-c", "safe.directory=*", "ls-files", "--cached", "--others", "--exclude-standard", "-z"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    return [ROOT / name for name in listing.split("\0") if name and (ROOT / name).is_file()]


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
    files = list((ROOT / "src" / "jacaros" / "bdi").rglob("*.py"))
    texts = [file.read_text(encoding="utf-8") for file in files]
    names = [node for text in texts for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Name)]
    untyped = sum(node.id == "Any" for node in names)
    assert 1000 * untyped / sum(text.count("\n") for text in texts) <= 10
