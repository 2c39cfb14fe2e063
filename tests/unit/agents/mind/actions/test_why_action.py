"""``.why``: how questions are written as terms, and what the answer is as a term."""

import pytest

from jacaros.agents.language.loader import parse_term
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.mind.actions.agents import written_question


@pytest.mark.parametrize(
    ("term", "question"),
    [
        ("stopped", "stopped"),
        ('"why did it stop"', "why did it stop"),
        ("{ +alarm(_) }", "+alarm(_)"),
        ("{ !go(dock) }", "!go(dock)"),
        ("belief(battery(12))", "belief battery(12)"),
        ("plan(low)", "plan @low"),
        ('plan("robot.asl:14")', "plan robot.asl:14"),
        ('command("/cmd_vel")', "command /cmd_vel"),
        ("operation(dock)", "operation dock"),
    ],
)
def test_questions_are_terms(term, question):
    assert written_question(lower_value(parse_term(term))) == question
