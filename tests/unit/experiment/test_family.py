"""The ten tests of the protocol, and what the page says of them, on made-up runs."""

from collections.abc import Iterable

import pytest
from made_up import outcome, outcomes

import sentences
import tables
from family import AGENTS, BASELINE, DONE, SILENT, compared, ends, family, points, runs_of, share
from outcomes import Damage
from record import Outcome
from scenarios import SCENARIOS
from sides import SIDES


def square(side: str, **how_many: int) -> list[Outcome]:
    """Runs of the square, the first seeds with the first outcome."""
    all_ends = [end for end, number in how_many.items() for _ in range(number)]
    return [
        outcome("square", side, 2001 + number)._replace(
            kind="slip", end=end, draw=0, damage=Damage(0, False, 0)
        )
        for number, end in enumerate(all_ends)
    ]


def of(found: Iterable[tuple[str, str, str | None]]) -> list[tuple[str, str, str | None]]:
    return [each for each in found if each[0] == "square"]


def verdicts(runs: list[Outcome]) -> list[tuple[str, str, str | None]]:
    return of((each.scenario, each.what, each.winner) for each in family(runs))


def test_a_side_wins_by_more_done_or_by_less_silence() -> None:
    agents, baseline = square(AGENTS, done=80, told=20), square(BASELINE, done=40, silent=60)
    assert verdicts(agents + baseline) == [("square", DONE, AGENTS), ("square", SILENT, AGENTS)]
    turned = [each._replace(side=BASELINE if each.side == AGENTS else AGENTS) for each in agents + baseline]
    assert verdicts(turned) == [("square", DONE, BASELINE), ("square", SILENT, BASELINE)]


def test_a_difference_that_ten_tests_can_give_by_chance_is_not_shown() -> None:
    runs = square(AGENTS, done=8, told=92) + square(BASELINE, told=100)
    (done,) = (each for each in family(runs) if (each.scenario, each.what) == ("square", DONE))
    assert done.interval.excludes_zero
    assert done.adjusted == pytest.approx(10 * 2 * 0.5**8)
    assert done.winner is None
    assert "square (+8 [" in sentences.undecided(runs)


def test_only_runs_with_the_same_seed_and_draw_are_pairs() -> None:
    runs = square(AGENTS, done=3) + square(BASELINE, done=2)
    assert compared(runs, "square", DONE).pairs == (2, 0, 0, 0)
    redrawn = [each._replace(draw=int(each.side == AGENTS and each.seed == 2001)) for each in runs]
    assert compared(redrawn, "square", DONE).pairs == (1, 0, 0, 0)


def test_exploratory_kinds_are_not_in_the_family() -> None:
    runs = square(AGENTS, done=80, told=20) + square(BASELINE, told=100)
    further = [each._replace(kind="dead_dock") for each in runs]
    assert {each.pairs for each in family(further)} == {(0, 0, 0, 0)}


def test_what_the_baseline_wins_is_said_to_be_lost() -> None:
    runs = square(AGENTS, silent=100) + square(BASELINE, done=100)
    said = sentences.lost(runs)
    assert said == (
        "The baseline is shown to be better in runs done: square (−100 [−100, −95]); "
        "runs that fail in silence: square (+100 [+95, +100])."
    )
    assert "the baseline in runs done: square" in sentences.conditions(runs)
    assert sentences.won(runs) == "In none of the ten comparisons were the agents shown to be better."


def test_kinds_and_damage_against_the_agents_are_listed_without_a_verdict() -> None:
    bumped = [each._replace(damage=Damage(2, False, 0)) for each in square(AGENTS, done=20, told=20)]
    runs = bumped + square(BASELINE, done=40)
    assert "In 2 of them," in sentences.exploratory(runs)
    assert [row[:3] for row in tables.against_table(runs).rows] == [
        ("square", "slip", DONE),
        ("square", "all", "a bump"),
    ]


def test_a_battery_that_is_meant_to_run_empty_does_not_count_as_damage() -> None:
    empty = [each._replace(scenario="fake_battery", kind="late") for each in square(AGENTS, done=40)]
    drained = [each._replace(damage=Damage(0, True, 0)) for each in empty]
    assert tables.against_table(drained + [each._replace(side=BASELINE) for each in empty]).rows == ()


def test_another_baseline_that_does_better_is_listed() -> None:
    runs = square(AGENTS, told=40) + square("state machine", done=40)
    (row,) = tables.against_table(runs).rows
    assert row[:3] == ("square", "beside state machine", DONE)
    assert str(row[3]).startswith("−100 [")
    assert not tables.against_table(square(AGENTS, done=40) + square("state machine", told=40)).rows


def test_seeds_without_an_effective_draw_are_counted() -> None:
    runs = [each for each in outcomes(4, others=False) if (each.scenario, each.seed) != ("patrol", 2003)]
    assert ", and 1 are left out" in sentences.drawn(runs)
    assert sentences.drawn(runs).startswith("Of 20 pairs of scenario and seed, ")


def test_sides_that_were_not_run_are_named() -> None:
    assert sentences.absent(outcomes(2)) == "These sides were not run: agents before."


def test_all_sides_that_run_are_on_the_page() -> None:
    assert set(SIDES) == {*tables.WHOLE, *tables.ABLATIONS} - {"agents before"}


def test_the_silent_share_is_of_the_failing_runs() -> None:
    runs = square(AGENTS, done=90, told=10) + square(BASELINE, done=50, told=10, silent=40)
    assert sentences.telling(runs) == (
        "Failing runs that end in silence: of the 10 failing runs of the agents, 0 (0–28\N{NO-BREAK SPACE}%); "
        "of the 50 failing runs of the baseline, 40 (67–89\N{NO-BREAK SPACE}%)."
    )


def test_tables_have_a_row_for_each_scenario_and_an_interval_in_each_cell() -> None:
    runs = outcomes(20)
    for name in ("H1", "H2"):
        table = tables.hypothesis_table(runs, name)
        assert [row[0] for row in table.rows] == list(SCENARIOS)
        assert all("–" in str(row[2]) and "[" in str(row[4]) for row in table.rows)


def test_the_outcomes_of_a_row_add_up_to_its_runs() -> None:
    for row in tables.outcome_table(outcomes(20)).rows:
        assert sum(int(str(cell).split(" ")[0]) for cell in row[3:6]) == row[2]


def test_further_sides_stand_beside_the_side_that_they_change() -> None:
    rows = tables.beside_table(outcomes(20), tables.ABLATIONS).rows
    assert {row[1:4] for row in rows} == {
        ("agents without urgency", AGENTS, 20),
        ("agents without checks", AGENTS, 20),
        ("baseline without pause", BASELINE, 20),
    }


def test_agreement_counts_runs_with_the_same_outcome() -> None:
    virtual = square(AGENTS, done=3, told=1)
    real = square(AGENTS, done=2, told=2) + square(BASELINE, done=1)
    agents, baseline = tables.agreement_table(virtual, real).rows
    assert agents == ("square", AGENTS, 4, share(3, 4), "3 / 1 / 0", "2 / 2 / 0")
    assert baseline == ("square", BASELINE, 0, "", "", "")
    assert sentences.agreeing(virtual, real) == (
        "5 runs were made on real ROS 2. 4 of them have a twin with the same draw on the virtual clock; "
        "3 (30–95\N{NO-BREAK SPACE}%) of these have the same outcome."
    )


def test_runs_with_further_kinds_have_a_table_of_their_own() -> None:
    runs = [each._replace(kind="dead_dock") for each in square(AGENTS, done=2, silent=1)]
    assert tables.further_table(runs).rows == (("dead_dock", "square", "2 / 0 / 1", ""),)


def test_cells_are_empty_without_runs() -> None:
    assert (share(0, 0), ends([]), runs_of([], "square", AGENTS)) == ("", "", [])


@pytest.mark.parametrize(("difference", "text"), [(0.123, "+12"), (-0.005, "0"), (-0.2, "−20"), (0.0, "0")])
def test_differences_are_in_points_with_a_sign(difference: float, text: str) -> None:
    assert points(difference) == text
