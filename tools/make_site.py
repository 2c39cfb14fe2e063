"""Build the site: make_site.py [FOLDER]    the version goes to FOLDER/VERSION (default: build/site)

Earlier versions in FOLDER stay: publish FOLDER as a whole. The build needs no network.
"""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

from site_pages import ROOT, BrokenPage, copy_pages, navigation, sources

SITE = ROOT / "site"
WORK = ROOT / "build" / "site-sources"
LIVE = ROOT / "build" / "live"
"""Where `make live` builds the pages with Python in them; the site is complete without."""
ADDRESS = "https://jacaros.github.io/jacaros/"


def version() -> str:
    """Return the version that readers select: two numbers, as fixes change no page."""
    text = (ROOT / "src/jacaros/version.py").read_text(encoding="utf-8")
    found = re.search(r'VERSION = "(\d+\.\d+)', text)
    assert found is not None
    return found[1]


def prepare() -> None:
    """Write what the generator reads: pages, settings, overrides."""
    shutil.rmtree(WORK, ignore_errors=True)
    shutil.copytree(SITE / "overrides", WORK / "overrides")
    shutil.copytree(SITE / "assets", WORK / "pages" / "assets")
    shutil.copyfile(SITE / "literal_blocks.py", WORK / "literal_blocks.py")
    copy_pages(WORK / "pages")
    settings = (SITE / "mkdocs.yml").read_text(encoding="utf-8")
    settings = settings.replace(f"site_url: {ADDRESS}", f"site_url: {ADDRESS}{version()}/")
    if LIVE.exists():
        settings = settings.replace("live: false", "live: true")
        shutil.copytree(LIVE, WORK / "pages" / "live")
    menu = json.dumps(navigation(sources()), indent=1)  # JSON is YAML
    (WORK / "mkdocs.yml").write_text(f"{settings}\nnav: {menu}\n", encoding="utf-8")


def publish(folder: Path) -> None:
    """Move the built site to its version's folder, and name all versions for the menu."""
    target = folder / version()
    shutil.rmtree(target, ignore_errors=True)
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.move(WORK / "site", target)
    found = [each.name for each in folder.iterdir() if re.fullmatch(r"\d+\.\d+", each.name)]
    found.sort(key=lambda name: [int(number) for number in name.split(".")], reverse=True)
    versions = [
        {"version": name, "title": name, "aliases": ["latest"] * (name == found[0])} for name in found
    ]
    (folder / "versions.json").write_text(json.dumps(versions), encoding="utf-8")
    (folder / "index.html").write_text(
        f'<!doctype html><title>JaCaROS</title><meta http-equiv="refresh" content="0; url={found[0]}/">\n',
        encoding="utf-8",
    )


def main() -> int:
    """Build the site and return the exit code: 1 after a warning."""
    folder = Path(sys.argv[1]) if sys.argv[1:] else ROOT / "build" / "site"
    try:
        prepare()
    except BrokenPage as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    code = subprocess.call((sys.executable, "-m", "zensical", "build", "--strict", "--clean"), cwd=WORK)
    if code == 0:
        publish(folder)
        print(f"{folder / version() / 'index.html'}")
    return code


if __name__ == "__main__":
    raise SystemExit(main())
