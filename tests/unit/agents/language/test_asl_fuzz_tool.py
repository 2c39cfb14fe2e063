"""The fuzzer of `tools`, for a moment: whatever a text is, it is a program that can be run, or there are diagnostics."""

import sys
from pathlib import Path
from random import Random

import pytest

ROOT = Path(__file__).parents[4]
sys.path.insert(0, str(ROOT / "tools"))

import fuzz  # noqa: E402
from program_grammar import Grammar  # noqa: E402

from jacaros.agents.language.loader import load_program  # noqa: E402
from jacaros.agents.language.lowering import format_plan, format_term  # noqa: E402
from jacaros.agents.language.nodes import Program  # noqa: E402


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Programs may save files."""
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("number", range(1, 181))
def test_a_text_is_a_program_or_there_are_diagnostics(number):
    how, text = fuzz.text_of(2026, number)
    outcome = fuzz.examine(text)
    assert outcome == "program" or how != "made"


def test_a_text_belongs_to_its_seed_and_number():
    assert fuzz.text_of(3, 14) == fuzz.text_of(3, 14)
    assert fuzz.text_of(3, 14) != fuzz.text_of(3, 15)


def numbered(program: Program) -> str:
    """Clauses as text, with unnamed variables as they are read in this order."""
    clauses = [f"{format_term(belief)}." for belief in program.beliefs]
    clauses += [f"!{format_term(goal)}." for goal in program.goals]
    return "\n".join([*clauses, *(format_plan(plan) for plan in program.plans)]) + "\n"


@pytest.mark.parametrize("number", range(60))
def test_formatted_programs_read_back_as_the_same_tree(number):
    grammar = Grammar(Random(number), 3)
    text = "".join(
        grammar.random.choice((grammar.belief, grammar.rule, grammar.goal, grammar.plan))() for _ in range(6)
    )
    once = numbered(load_program("made.asl", text)[0])
    # Reading the text of a tree gives unnamed variables new numbers: after one more turn they are in order.
    program, _ = load_program("made.asl", once)
    again = numbered(program)
    assert load_program("made.asl", again)[0] == program
