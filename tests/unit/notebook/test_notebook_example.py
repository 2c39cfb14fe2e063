"""The example notebook, run in a kernel as Jupyter runs it."""

from pathlib import Path
from typing import Any

import nbformat
from nbclient import NotebookClient

EXAMPLE = Path(__file__).parents[3] / "examples" / "11_notebook" / "robot.ipynb"


def text_of(cell: Any) -> str:
    return "".join(each.get("text", "") + each.get("data", {}).get("text/plain", "") for each in cell.outputs)


def test_the_example_runs_from_top_to_bottom(tmp_path: Path) -> None:
    notebook = nbformat.read(EXAMPLE, 4)  # type: ignore[no-untyped-call]
    NotebookClient(notebook, timeout=120, resources={"metadata": {"path": str(tmp_path)}}).execute()
    cells = [each for each in notebook.cells if each.cell_type == "code"]
    assert text_of(cells[1]).startswith("[agent] side 1\n[agent] side 2\n[agent] side 3\n[agent] side 4\n")
    assert "agent started `rotate(90)`" in text_of(cells[2])
    assert "alice has counted to 3" in text_of(cells[-1])
    html = [each.data["text/html"] for each in cells[1].outputs if "text/html" in each.get("data", {})]
    assert "data:image/svg+xml;base64," in html[0]
    assert list(tmp_path.iterdir()) == []
