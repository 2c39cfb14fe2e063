import pytest

from jacaros.agents.mind.actions.internal_action import STANDARD

ARITIES = {
    (0, None): ".print .println",
    (1, None): ".printf .log",
    (2, None): ".concat",
    (0, 0): ".print_unifier",
    (0, 2): ".stopMAS",
    (
        1,
        1,
    ): ".empty .string .list .number .atom .literal .structure .ground .internal_action .verbose .my_name"
    " .all_names .version .nano_time .set_random_seed",
    (1, 2): ".puts .kill_agent .queue.create",
    (1, 3): ".random .create_agent",
    (2, 2): ".length .member .reverse .sort .shuffle .sublist .prefix .suffix .upper_case .lower_case"
    " .term2string .type .copy_term .rename_apart .remove_source_annot",
    (2, 3): ".max .min",
    (2, 4): ".substring",
    (3, 3): ".nth .union .intersection .difference .add_annot .add_nested_source .date .map.put",
    (3, 4): ".delete .range .time .map.get",
    (4, 4): ".replace",
}
CASES = [(name, arity) for arity, names in ARITIES.items() for name in names.split()]


@pytest.mark.parametrize(("name", "arity"), CASES)
def test_each_action_takes_its_number_of_arguments(name, arity):
    action = STANDARD[name]
    assert (action.minimum, action.maximum) == arity


def test_actions_can_be_called_with_the_fewest_arguments(mind):
    assert mind.succeeds(".print")
    assert mind.succeeds(".stopMAS")


def test_the_mind_declares_no_actions_but_those_of_the_language():
    assert [name for name in STANDARD if not name.startswith(".")] == []
