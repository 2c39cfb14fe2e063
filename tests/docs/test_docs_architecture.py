"""The page about the architecture is true: its picture shows the layers of the import contracts, its packages exist."""

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src" / "jacaros"
PAGE = (ROOT / "docs" / "explanation" / "architecture.md").read_text(encoding="utf-8")
PATH = re.compile(r"`((?:agents|artifacts|robots|runtime|serving|look|fleet|testing|tests)(?:/[\w.]+)+)`")


def test_the_picture_shows_the_layers_that_the_contracts_allow(tmp_path: Path) -> None:
    drawn = tmp_path / "architecture.svg"
    subprocess.run([sys.executable, ROOT / "tools" / "draw_layers.py", drawn], check=True)
    shown = ROOT / "docs" / "images" / "architecture.svg"
    assert shown.read_text(encoding="utf-8") == drawn.read_text(encoding="utf-8"), "run `make reference`"


def test_the_page_names_each_package_of_the_tree() -> None:
    packages = {file.parent.name for file in SOURCE.glob("*/__init__.py")}
    assert packages == {
        "agents",
        "artifacts",
        "browser",
        "editors",
        "fleet",
        "look",
        "notebook",
        "porting",
        "robots",
        "runtime",
        "serving",
        "testing",
    }
    for package in packages:
        row = next(line for line in PAGE.splitlines() if line.startswith("|") and f"`{package}`" in line)
        named = set(re.findall(r"`(\w+)`", row))
        assert named >= {file.parent.name for file in SOURCE.glob(f"{package}/*/__init__.py")}, package


def test_the_paths_on_the_page_exist() -> None:
    for path in PATH.findall(PAGE):
        assert (SOURCE / path).exists() or (ROOT / path).exists(), path
