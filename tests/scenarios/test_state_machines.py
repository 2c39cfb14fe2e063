"""The baselines of YASMIN: their policies are those of the table, and they pass the checkers where YASMIN is."""

import ast
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
from examples_lab import EXAMPLES

from jacaros.runtime.files.yaml import plain_values

sys.path.insert(0, str(EXAMPLES.parent / "experiment"))

from runs import CYCLES, NEAR
from scenarios import FOLDER
from sides import ALL, OVER_NAV2, SIDES, Setting

POLICIES, _ = plain_values((FOLDER / "policies.yaml").read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", OVER_NAV2)
def test_the_parameters_of_the_machine_are_the_policies(name: str) -> None:
    tree = ast.parse((FOLDER / "baseline" / f"yasmin_{name}.py").read_text(encoding="utf-8"))
    [parameters] = [
        ast.literal_eval(node.value)
        for node in tree.body
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "PARAMETERS"
    ]
    parameters.pop("shift", None)  # which runs of the experiment set
    assert parameters == {policy: POLICIES[policy] for policy in ("attempts", "pause", "charged_within")}


@pytest.mark.slow
@pytest.mark.skipif(find_spec("yasmin") is None, reason="needs YASMIN 3.5.1, see experiment/README.md")
@pytest.mark.parametrize("name", OVER_NAV2)
def test_the_machine_passes_the_checker_and_repeats(name: str, tmp_path: Path) -> None:
    first, second = (SIDES["state machine"].run(Setting(name, 0, "faults: {}\n", tmp_path)) for _ in range(2))
    limits = {"cycles": CYCLES, "near": NEAR} if name == "patrol" else {}
    assert ALL[name].judge(first, **limits).complaints == []
    assert (first.errors, first.exit_code) == ([], 0)
    assert (first.seconds, first.ground_truth.path()) == (second.seconds, second.ground_truth.path())
