"""Compare the size of each package with the budget in budget.toml.

python tools/budget.py     prints lines of code, files and their limits; fails if a package is above one

Lines of code are those with code on them: no blank lines, comments and docstrings.
"""

import ast
import io
import sys
import tokenize
import tomllib
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).parents[1]
SOURCE = ROOT / "src" / "jacaros"
LAYERS = ("agents", "artifacts", "look", "robots", "runtime")
"""Packages whose packages have a budget each."""
LOOSE = "."
"""The package of the modules directly in the root."""
_NO_CODE = {
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.ENDMARKER,
}


def lines_of_code(source: str) -> int:
    """Return the number of lines of a module that hold code."""
    held: set[int] = set()
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type not in _NO_CODE:
            held.update(range(token.start[0], token.end[0] + 1))
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            for statement in node.body:
                # The texts below constants and attributes are documentation, too.
                if isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant):
                    held.difference_update(range(statement.lineno, (statement.end_lineno or 0) + 1))
    return len(held)


def sizes() -> dict[str, tuple[int, int]]:
    """Return the lines of code and the number of files of each package."""
    lines: Counter[str] = Counter()
    files: Counter[str] = Counter()
    for path in SOURCE.rglob("*.py"):
        inside = path.relative_to(SOURCE).parts
        package = (
            "/".join(inside[: 2 if inside[0] in LAYERS and len(inside) > 2 else 1])
            if len(inside) > 1
            else LOOSE
        )
        lines[package] += lines_of_code(path.read_text())
        files[package] += 1
    return {package: (lines[package], files[package]) for package in sorted(files)}


def limits() -> dict[str, tuple[int, int]]:
    """Return the limits of lines and files of each package."""
    told = tomllib.loads((ROOT / "tools" / "budget.toml").read_text())
    return {package: (limit["lines"], limit["files"]) for package, limit in told.items()}


def excesses() -> list[str]:
    """Return one line for each package that is above its budget, or has none."""
    allowed = limits()
    found = []
    for package, (lines, files) in sizes().items():
        if package not in allowed:
            found.append(f"{package}: has no budget in tools/budget.toml")
            continue
        for number, limit, what in zip(
            (lines, files), allowed[package], ("lines of code", "files"), strict=True
        ):
            if number > limit:
                found.append(f"{package}: {number} {what}, the budget is {limit}")
    return found


def main() -> int:
    """Print the table."""
    allowed, measured = limits(), sizes()
    print(f"{'package':20}{'lines':>8}{'limit':>8}{'files':>8}{'limit':>8}")
    for package, (lines, files) in measured.items():
        most_lines, most_files = allowed.get(package, (0, 0))
        print(f"{package:20}{lines:8}{most_lines:8}{files:8}{most_files:8}")
    totals = [sum(column) for column in zip(*measured.values(), strict=True)]
    print(f"{'together':20}{totals[0]:8}{'':8}{totals[1]:8}")
    found = excesses()
    print(*found, sep="\n", end="\n" if found else "")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
