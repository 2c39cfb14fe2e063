"""The Python file that `jacaros port` writes."""

import subprocess
import sys
from pathlib import Path

import pytest
from porting_lab import JAVA, ported

from jacaros.porting import NotPortable, port
from jacaros.runtime.cli.main import call

HEAD = "import cartago.*; public class A extends Artifact { "


def method(java: str) -> str:
    """Return the Python lines of an operation with this body."""
    text = port(
        "A.java",
        f"{HEAD}int n; String s; Map<String, String> m; @OPERATION void f(int x, double y, Object o) {{ {java} }} }}",
    ).text
    return "\n".join(line.removeprefix("        ") for line in text.partition("def f(")[2].splitlines()[1:])


@pytest.mark.parametrize("name", sorted(path.name for path in JAVA.iterdir()))
def test_ruff_accepts_it(tmp_path: Path, name: str) -> None:
    path = tmp_path / "artifacts.py"
    path.write_text(ported(name).text, encoding="utf-8")
    command = [sys.executable, "-m", "ruff", "check", "--isolated", "--target-version", "py311", str(path)]
    checked = subprocess.run(command, capture_output=True, text=True, check=False)
    assert checked.returncode == 0, checked.stdout


@pytest.mark.parametrize(
    ("java", "python"),
    [
        ("n = x / 2;", "self.n = int(x / 2)"),
        ("y = y / 2;", "y = y / 2"),
        ("n = (x + 1) * 2 - -x;", "self.n = (x + 1) * 2 - -x"),
        ("n += x++;", "self.n += x\nx += 1"),
        ('s = "a" + x + o;', "self.s = f\"a{x}{text(o)}\""),
        ('s = x + x + "a";', 'self.s = f"{x + x}a"'),
        ('s = "{" + s.substring(1);', 'self.s = f"{{{self.s[1:]}"'),
        ('if (!s.equals("a") && o != null) n--;', 'if self.s != "a" and o is not None:\n    self.n -= 1'),
        ("while (!(x > 1 || y < 2)) x--;", "while not (x > 1 or y < 2):\n    x -= 1"),
        ("for (int i = x; i >= 0; i--) n += i;", "for i in range(x, -1, -1):\n    self.n += i"),
        ("for (int i = 0; i <= x; i++) n += i;", "for i in range(x + 1):\n    self.n += i"),
        ("for (int i = 1; i < 9; i *= 2) n += i;", "i = 1\nwhile i < 9:\n    self.n += i\n    i *= 2"),
        ("do { n++; } while (n < 3);", "while True:\n    self.n += 1\n    if not self.n < 3:\n        break"),
        ("n = x > 0 ? x : -x;", "self.n = x if x > 0 else -x"),
        ("int[][] g = new int[2][x]; g[1][0] = 5;", "g = [[0] * x for _ in range(2)]\ng[1][0] = 5"),
        ("Thread.sleep(50);", "await self.clock.sleep(0.05)"),
        ("int list = 3; n = list;", "list_ = 3\nself.n = list_"),
        ("// why\nn = 1;", "# why\nself.n = 1"),
        ("int unused = x;", "_unused = x"),
        ('signal(getCurrentOpAgentId(), "seen", n);', 'self.signal_to(self.caller, "seen", self.n)'),
        ('removeObsPropertyByTemplate("p", x, null);', 'self.remove_property("p", x, None)'),
        (
            'getObsPropertyByTemplate("p", x, null).updateValue(1, y);',
            'self.update_value("p", 1, y, where=(x, None,))',
        ),
        ('if (getObsProperty("p") == null) n = 1;', 'if not self.has_property("p"):\n    self.n = 1'),
    ],
)  # fmt: skip
def test_a_statement_has_its_translation(java: str, python: str) -> None:
    assert method(java).strip() == python


def test_two_names_of_a_line_can_be_unused() -> None:
    java = "for (Map.Entry<String, String> e : m.entrySet()) { B.b(e.getKey(), e.getValue()); }"
    assert method(java).strip().startswith("for _e_key, _e_value in self.m.items():\n")


@pytest.mark.parametrize(
    "java",
    [
        "n = o.hashCode();",
        "new Thread() { public void run() { } }.start();",
        "for (int i = 0; ; i++) { if (i > x) break; else continue; }",
        "outer: while (true) { break outer; }",
        "n = x >>> 1;",
    ],
)
def test_a_statement_without_translation_is_a_comment_and_fails(java: str) -> None:
    lines = method(java).strip().splitlines()
    assert lines[0] == f"# Java, line 1: {java}"
    assert lines[1:] == ['self.fail("not ported: line 1 of A.java", "not_ported", 1)']


def test_what_depends_on_a_missing_variable_is_left_too() -> None:
    text = method("Foo foo = new Foo(); foo.bar(); n = 1;")
    assert text.count("not_ported") == 2
    assert "self.n = 1" in text


def test_a_handler_does_not_catch_what_is_not_ported() -> None:
    text = method("try { o.notify(); } catch (Exception e) { }")
    assert "except OperationFailed:\n    raise\nexcept Exception:" in text


def test_a_window_is_left_out_and_does_not_fail() -> None:
    java = (
        "import javax.swing.*; public class A extends Artifact { View view; void init() { view = new View(); }"
        ' @OPERATION void show(String s) { view.setTitle(s); signal("shown"); } class View extends JFrame { } }'
    )
    found = port("A.java", java)
    assert found.left == []
    assert "not_ported" not in found.text
    assert "# Java, line 1, a window: view.setTitle(s);" in found.text
    assert 'self.signal("shown")' in found.text


@pytest.mark.parametrize(
    "java",
    [
        "void draw(Graphics g) { g.drawLine(0, 0, 9, 9); }",
        'void fill(Map m) { m.put(1, new JLabel("S")); }',
    ],
)
def test_parts_of_windows_can_be_parameters_and_elements(java: str) -> None:
    found = port("A.java", f"import java.awt.Graphics; import javax.swing.JLabel; {HEAD}{java} }}")
    assert found.left == []
    assert found.windows == [("A.java", 1)]


def test_the_lines_that_are_left_are_counted() -> None:
    found = ported("Buffer.java")
    assert found.left == [("Buffer.java", 100), ("Buffer.java", 101)]
    assert found.artifacts == ["Buffer"]
    assert found.environments == []
    assert 80 < found.lines < 100


@pytest.mark.parametrize(
    ("java", "message"),
    [
        ("class A extends Artifact {\n int f( \n}", "A.java:2: error: this is not valid Java"),
        ("class A { }", "A.java: error: no class in it is an artifact or an environment"),
        ("", "A.java: error: no class in it is an artifact or an environment"),
    ],
)
def test_other_files_are_refused(java: str, message: str) -> None:
    with pytest.raises(NotPortable) as wrong:
        port("A.java", java)
    assert str(wrong.value) == message


def test_the_command_writes_a_new_file_only(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    output = tmp_path / "artifacts" / "buffer.py"
    command = ["port", str(JAVA / "Buffer.java"), "-o", str(output)]
    assert call(command) == 0
    assert output.read_text(encoding="utf-8") == ported("Buffer.java").text
    assert capsys.readouterr().err.splitlines()[1] == "left to you: lines 100-101"
    assert call(command) == 2
    assert "already exists" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "code", "error"),
    [
        ("None.java", 2, "file not found"),
        ("x.txt", 2, "unsupported file type"),
        ("Latin.java", 1, "line 1 contains a byte (0xe9) that is not UTF-8"),
        ("Class.java", 1, "line 1 contains a NUL byte"),
    ],
)
def test_the_command_explains_a_wrong_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, code: int, error: str
) -> None:
    (tmp_path / "Latin.java").write_bytes(b"// caf\xe9")
    (tmp_path / "Class.java").write_bytes(b"\xca\xfe\xba\xbe\0")
    assert call(["port", str(tmp_path / name)]) == code
    assert error in capsys.readouterr().err
