"""`jacaros new`: each template is a project whose README works as it stands."""

import json
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from ruamel.yaml import YAML

from jacaros.runtime.cli.main import call
from jacaros.runtime.cli.new import TEMPLATES, project_files


def jacaros(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run a command in the folder of a project."""
    return subprocess.run(
        [sys.executable, "-m", "jacaros", *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        encoding="utf-8",
        timeout=120,
        check=False,
    )


@pytest.fixture(scope="module", params=TEMPLATES)
def project(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A project made from a template."""
    folder = tmp_path_factory.mktemp("new") / "lawn_mower"
    assert call(["new", str(folder), "--template", request.param]) == 0
    return folder


@pytest.mark.slow
def test_the_three_commands_of_its_readme_work(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    readme = (project / "README.md").read_text(encoding="utf-8").partition("\n## ")[0]
    run, test, check = (
        shlex.split(line)[1:] for line in readme.splitlines() if line.startswith("    jacaros ")
    )
    ran = jacaros(project, *run, "--clock", "fast", "--for", "120")
    assert ran.returncode == 0, ran.stderr
    assert len(ran.stdout.splitlines()) >= 3
    assert "cannot" not in ran.stdout
    assert "error" not in ran.stderr
    assert "warning" not in ran.stderr
    monkeypatch.chdir(project)
    assert call(test) == 0
    assert call([*check, "--strict"]) == 0


def test_its_programs_have_the_usual_layout(project: Path) -> None:
    assert call(["fmt", "--check", str(project)]) == 0


def test_its_ci_runs_the_tests(project: Path) -> None:
    workflow = YAML().load(project / ".github" / "workflows" / "test.yml")
    commands = [step["run"] for step in workflow["jobs"]["test"]["steps"] if "run" in step]
    assert commands == ["pip install jacaros", "jacaros check .", "jacaros test"]


def test_the_tasks_of_its_editor_are_its_commands(project: Path) -> None:
    tasks = json.loads((project / ".vscode" / "tasks.json").read_text(encoding="utf-8"))["tasks"]
    commands = [task["command"] for task in tasks]
    readme = (project / "README.md").read_text(encoding="utf-8")
    assert all(f"    {command}\n" in readme for command in commands)
    assert (project / shlex.split(commands[0])[2]).is_file()


@pytest.mark.parametrize("template", TEMPLATES)
def test_no_file_keeps_the_name_of_the_template(template: str) -> None:
    for path, text in project_files("lawn_mower", template):
        assert "my_project" not in f"{path} {text}", path


def test_a_folder_that_exists_is_not_touched(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "mower").mkdir()
    assert call(["new", str(tmp_path / "mower")]) == 2
    assert "already exists" in capsys.readouterr().err
    assert list((tmp_path / "mower").iterdir()) == []


@pytest.mark.parametrize(
    ("name", "instead"),
    [
        ("My-Robot", "my_robot"),
        ("2nd", "my_robot"),
        ("class", "my_robot"),
        ("büro", "b_ro"),
        ("", "my_robot"),
    ],
)
def test_a_name_that_is_not_an_identifier_is_an_error(
    capsys: pytest.CaptureFixture[str], name: str, instead: str
) -> None:
    assert call(["new", name]) == 2
    error, help = capsys.readouterr().err.splitlines()
    assert error.startswith(f"error: invalid name of a project: `{name}`; expected ")
    assert help.endswith(f"help: jacaros new {instead}")


@pytest.mark.slow
def test_the_ros2_package_installs_what_it_runs(tmp_path: Path) -> None:
    """Do what colcon does with an ament_python package, and run what `ros2 run` would start."""
    source, prefix = tmp_path / "mower", tmp_path / "install"
    assert call(["new", str(source), "--template", "ros2-package"]) == 0
    subprocess.run(
        [sys.executable, "-W", "ignore", "setup.py", "-q", "install", "--prefix", str(prefix),
         "--record", str(tmp_path / "record"), "--single-version-externally-managed"],
        cwd=source, check=True, capture_output=True,
    )  # fmt: skip
    share = prefix / "share" / "mower"
    assert {path.name for path in share.iterdir()} >= {"package.xml", "mower.jcm", "robot.asl", "robot.yaml"}
    assert (share / "launch" / "agents.launch.xml").is_file()
    assert (prefix / "share/ament_index/resource_index/packages/mower").is_file()
    assert (prefix / "lib/mower/agents").is_file(), "where `ros2 run mower agents` looks"
    ran = jacaros(share, "run", "mower.jcm", "--clock", "fast")
    assert ran.stdout.splitlines()[-1] == "[robot] done"
