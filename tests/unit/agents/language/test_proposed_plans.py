"""Plans that a stranger proposes: what is permitted passes, everything else is an error."""

import doctest

import pytest

from jacaros.agents.checks import proposals
from jacaros.agents.checks.proposals import HARMLESS, LONGEST, Permitted, check_plans
from jacaros.agents.language.diagnostics import AslError
from jacaros.agents.mind.actions import standard
from jacaros.agents.mind.actions.internal_action import STANDARD

PERMITTED = Permitted(goals=["tour/0", "go/1"], operations=["dock/0"], beliefs=["seen/1"])


@pytest.mark.parametrize(
    "plans",
    [
        ["+!tour <- !go(lab); dock."],
        [
            "+!tour : place(X) & not closed(X)\n  <- +seen(X);\n     !go(X)[retry(3)].",
            "-!tour[error(E)] <- .print(E).",
        ],
        ["+!tour <- dock[timeout(100)]."],
        ["+!go(X) <- if (X > math.sqrt(4)) { dock } else { .wait(100) }."],
        ["+!tour <- .findall(X, seen(X), L); for (.member(Y, L)) { !go(Y) }."],
    ],
)
def test_permitted_plans_come_back_one_by_one(plans: list[str]) -> None:
    assert check_plans("// my plans\n" + " ".join(plans), PERMITTED) == plans


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("+!tour <- undock.", "operation `undock/0` is not permitted"),
        ("+!tour <- dock(1).", "operation `dock/1` is not permitted"),
        ("+!tour <- dock[artifact_name(other)].", "an annotation that chooses an artifact is not permitted"),
        ("+!tour <- dock[timeout(1)|Others].", "an annotation that chooses an artifact is not permitted"),
        ("+!tour <- ns::dock.", "operation: a variable or a namespace is not permitted"),
        ("+!tour <- X = dock; X.", "operation: a variable or a namespace is not permitted"),
        ("+!tour <- !charge.", "goal `charge/0` is not permitted"),
        ("+!tour <- !G.", "goal: a variable or a namespace is not permitted"),
        ("+!tour <- !!go(lab).", "`!!` is not permitted: its goal would outlive this plan"),
        ("+!other <- dock.", "goal `other/0` is not permitted"),
        ("+seen(X) <- dock.", "only plans for goals are permitted"),
        ("+?tour <- dock.", "only plans for goals are permitted"),
        ("+!tour { +!charge <- dock. }", "goal `charge/0` is not permitted"),
        ("+!tour <- +battery(100).", "change of the belief `battery/1` is not permitted"),
        ("+!tour <- -seen(_); +~seen(1).", "change of the belief `~seen/1` is not permitted"),
        ("+!tour <- .create_agent(eve).", "internal action `.create_agent` is not permitted"),
        ("+!tour : .findall(X, .include(X), L) <- dock.", "internal action `.include` is not permitted"),
        ("+!tour <- if (not .stopMAS) { dock }.", "internal action `.stopMAS` is not permitted"),
        ("+!tour <- cartago.new_obj(\"os\", [], X).", "internal action `cartago.new_obj` is not permitted"),
        ("+!tour <- .wait(my.norm(1)).", "internal action `my.norm` is not permitted"),
        ("+!tour <- .print({ +!go(_) <- dock }).", "plans as values are not permitted"),
        ("@t[atomic] +!tour <- dock.", "labels and annotations of plans are not permitted"),
        ("seen(lab). +!tour <- dock.", "only plans can be proposed"),
        ("!go(lab). +!tour <- dock.", "only plans can be proposed"),
        ('{ include("plans.asl") } +!tour <- dock.', "included file not found: `plans.asl`"),
        ("{ offer(goal, tour) } +!tour <- dock.", "only plans can be proposed"),
        ("// nothing", "there is no plan"),
        ("+!tour <- dock" + "; dock" * 600 + ".", "the plans are too large"),
        ("// " + "x" * LONGEST, f"the plans have {LONGEST + 3} characters; the limit is {LONGEST}"),
        ("+!tour <- dock", "plan without a final `.`"),
    ],
)  # fmt: skip
def test_everything_else_is_an_error(text: str, message: str) -> None:
    with pytest.raises(AslError) as wrong:
        check_plans(text, PERMITTED)
    assert any(message in each.message for each in wrong.value.diagnostics), str(wrong.value)


def test_directives_do_not_come_back() -> None:
    assert check_plans('{ register_function("my.f") } +!tour <- dock.', PERMITTED) == ["+!tour <- dock."]


def test_harmless_internal_actions_exist() -> None:
    assert standard.__doc__  # importing it declares them
    assert set(STANDARD) >= HARMLESS


def test_the_examples_of_the_module() -> None:
    assert doctest.testmod(proposals, optionflags=doctest.ELLIPSIS).failed == 0
