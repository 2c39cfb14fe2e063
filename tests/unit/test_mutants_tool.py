"""The tool that counts the changes which tests notice: what it changes, and what it says of a package with known gaps."""

import subprocess
import sys
from pathlib import Path

import pytest

TOOLS = Path(__file__).parents[2] / "tools"
sys.path.insert(0, str(TOOLS))

from mutants import chosen  # noqa: E402
from mutation_operators import Mutant, mutants_of  # noqa: E402


def changes(source: str) -> set[str]:
    """All mutants of a function body, each as the text that takes a place."""
    return {each.text for each in mutants_of("file.py", f"def f():\n    {source}\n".encode())}


@pytest.mark.parametrize(
    ("source", "texts"),
    [
        ("x = a < b", {"a >= b"}),
        ("x = len(a) < b", {"len(a) >= b", "len(a) <= b"}),
        ("x = a - b", {"a + b"}),
        ("x = a and b or c", {"a or b", "(a and b) and c", "a and b and c"}),
        ("x = not a", {"a"}),
        ("x = 2", {"3"}),
        ("x = 0.5", {"1.0"}),
        ("x = True", {"False"}),
        ("x = min(a, b)", {"max"}),
        ("x = a if b else c", {"not b"}),
        ("x += 2", {"pass", "x -= 2", "3"}),
        ("self.x = a", {"pass"}),
        ("stop()", {"pass"}),
        ("f(a, b, c)", {"pass", "f(b, a, c)"}),
        ("f(a, 'b', *c)", {"pass"}),
        ("x = f(a, c=b)", {"f(a)"}),
        ("for a in b: continue", {"pass", "break"}),
        ("return a", {"return None"}),
        ("return True", {"False"}),
        ("return", {"pass"}),
        ("raise ValueError(3)", {"pass"}),
    ],
)
def test_an_operator_replaces_a_place_by_another_meaning(source: str, texts: set[str]) -> None:
    found = changes(source)
    assert found <= texts or found == texts - {"(a and b) and c"}
    assert len(found) >= len(texts) - 1


@pytest.mark.parametrize(
    "source",
    [
        '"""A docstring with 3 numbers."""',
        "x: Literal[3]",
        "x = f'{a + b}'",
        "x = 'a' + b",
        "self._log(a + b)",
        "assert a < b",
        "raise",
    ],
)
def test_what_no_test_should_notice_is_not_changed(source: str) -> None:
    assert changes(source) <= {"pass"}
    assert source == "raise" or not changes(source)


def test_bodies_of_protocols_enumerations_and_type_checks_are_not_changed() -> None:
    source = (
        "if TYPE_CHECKING:\n    x = 1\n"
        "class P(Protocol):\n    def f(self, n: int = 3) -> int: return n\n"
        "class E(Enum):\n    A = 1\n"
        "__all__ = [1]\n"
        "def f(x: Annotated[int, 3]) -> Literal[3]: ...\n"
    )
    assert mutants_of("file.py", source.encode()) == []


def test_every_mutant_is_a_program_that_differs() -> None:
    path = TOOLS / "mutation_operators.py"
    source = path.read_bytes()
    mutants = mutants_of(path.name, source)
    assert len(mutants) > 50
    for mutant in mutants:
        assert mutant.apply(source) != source
        compile(mutant.apply(source), path.name, "exec")


def test_shards_of_a_sample_are_the_sample() -> None:
    mutants = [Mutant("f.py", line, line, "constant", line, line + 1, "2", ()) for line in range(100)]
    sample = chosen(mutants, 20, 7, (1, 1))
    shards = [chosen(mutants, 20, 7, (part, 3)) for part in (1, 2, 3)]
    assert sorted(each for shard in shards for each in shard) == sample
    assert len(sample) == 20
    assert chosen(mutants, 20, 8, (1, 1)) != sample
    files = [Mutant(f"{line % 10}.py", *each[1:]) for line, each in enumerate(mutants)]
    assert {each.file for each in chosen(files, 20, 7, (1, 1))} == {f"{name}.py" for name in range(10)}
    assert chosen(mutants, 0, 7, (1, 1)) == mutants


PACKAGE = """
LIMIT = 3

def is_low(level):
    return level < LIMIT

def wait(n):
    while n:
        n -= 1

def doubled(x):
    return x * 2

def never_called():
    return False

def unchecked(x):
    return -x
"""

TESTS = """
import subprocess, sys
from pkg.code import doubled, is_low, unchecked, wait

def test_low():
    assert is_low(2) and not is_low(3)

def test_the_rest():
    wait(3)
    unchecked(doubled(1))
    program = "import pkg.code; print(pkg.code.doubled(4))"  # only this checks it
    assert subprocess.run([sys.executable, "-c", program], capture_output=True, text=True).stdout.strip() == "8"

def test_that_fails():
    assert not is_low(1)
"""


@pytest.mark.slow
def test_the_tool_finds_what_tests_miss(tmp_path: Path) -> None:
    package = tmp_path / "src" / "pkg"
    package.mkdir(parents=True)
    (package / "__init__.py").touch()
    (package / "code.py").write_text(PACKAGE, encoding="utf-8")
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests" / "test_code.py").write_text(TESTS, encoding="utf-8")
    options = ["--sample", "0", "--least", "90", "--limit", "1"]
    command = [sys.executable, TOOLS / "mutants.py", "pkg=tests", "--root", tmp_path, *options]
    found = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    report = found.stdout
    assert found.returncode == 1, found.stderr
    assert "left out, as it fails without a change: tests/test_code.py::test_that_fails" in report
    survived = [each[1:].strip() for each in report.splitlines() if each.startswith("+")]
    assert sorted(survived) == ["return None", "return True", "return x", "while not n:"]
    assert "reached by no test" in report  # never_called
    assert "3 killed by the time limit" in report  # n -= 2, n += 1, and nothing
