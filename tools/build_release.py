"""Build the wheel and the source distribution, the same to the last byte on every machine.

    python tools/build_release.py [FOLDER]      FOLDER: where they go, ``dist`` by default

They are built from a copy of the tracked files: owners, rights, times and order come from here, not from the checkout. The
time of all files is that of the last commit, or SOURCE_DATE_EPOCH (seconds since 1970). The versions of setuptools
and build do count: `constraints.txt` names those of a release.
"""

import gzip
import io
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
EARLIEST = 315532800
"""1980, the first year that archives of the form ZIP know."""


def tracked(root: Path) -> list[str]:
    """Return the names of the files to build from: those of git, or all where there is no repository."""
    if not (root / ".git").exists():
        return sorted(str(path.relative_to(root)) for path in root.rglob("*") if path.is_file())
    command = [
        "git",
        "-c",
        "safe.directory=*",
        "ls-files",
        "-z",
        "--cached",
        "--others",
        "--exclude-standard",
    ]
    listed = subprocess.run(command, cwd=root, capture_output=True, text=True, check=True).stdout
    return sorted(name for name in listed.split("\0") if name and (root / name).is_file())


def moment(root: Path) -> int:
    """Return the time of all files."""
    told = os.environ.get("SOURCE_DATE_EPOCH")
    if told is None and (root / ".git").exists():
        command = ["git", "-c", "safe.directory=*", "log", "-1", "--format=%ct"]
        told = subprocess.run(command, cwd=root, capture_output=True, text=True, check=True).stdout
    return max(int(told or EARLIEST), EARLIEST)


def copy_tree(root: Path, tree: Path, time: int) -> None:
    """Copy the tracked files with the same rights and times everywhere."""
    for name in tracked(root):
        source, copy = root / name, tree / name
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source, copy)
        copy.chmod(0o755 if source.stat().st_mode & 0o100 else 0o644)
        os.utime(copy, (time, time))


def repack(archive: Path, time: int) -> None:
    """Write a source distribution again: sorted, without owners, and with the same time for all."""
    packed = io.BytesIO()
    with (
        tarfile.open(archive) as old,
        tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as new,
    ):
        for member in sorted(old.getmembers(), key=lambda member: member.name):
            member.uid = member.gid = 0
            member.uname = member.gname = ""
            member.mtime = time
            member.mode = 0o755 if member.isdir() or member.mode & 0o100 else 0o644
            member.pax_headers = {}
            new.addfile(member, old.extractfile(member) if member.isfile() else None)
    archive.write_bytes(gzip.compress(packed.getvalue(), mtime=0))


def build(root: Path, folder: Path) -> list[Path]:
    """Build both into *folder* and return their paths; exits with the output of the builder if it fails."""
    time = moment(root)
    folder.mkdir(parents=True, exist_ok=True)
    os.umask(0o022)
    with tempfile.TemporaryDirectory() as scratch:
        tree, made = Path(scratch) / "tree", Path(scratch) / "dist"
        copy_tree(root, tree, time)
        command = [sys.executable, "-m", "build", "--no-isolation", "--outdir", str(made), str(tree)]
        environment = {**os.environ, "SOURCE_DATE_EPOCH": str(time), "PYTHONHASHSEED": "0"}
        done = subprocess.run(
            command, check=False, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        if done.returncode:
            sys.exit(done.stdout)
        for archive in made.glob("*.tar.gz"):
            repack(archive, time)
        return [Path(shutil.copy(path, folder)) for path in sorted(made.iterdir())]


if __name__ == "__main__":
    for path in build(ROOT, Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "dist"):
        sys.stdout.write(f"{path}\n")
