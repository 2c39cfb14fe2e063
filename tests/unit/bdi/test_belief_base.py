"""The belief base against a simple model, and its indexes."""

from hypothesis import given
from hypothesis import strategies as st

from jacaros.bdi.belief_base import BeliefBase, Table
from jacaros.terms.values import BY_SELF, Var, atom, functor

OPERATIONS = st.lists(
    st.tuples(st.sampled_from(["add", "last", "remove"]), st.integers(0, 4), st.integers(0, 2)), max_size=40
)


class Model:
    """Rows in the order in which they answer: a plain list."""

    def __init__(self) -> None:
        self.rows: list[tuple[float, float]] = []

    def apply(self, operation: str, row: tuple[float, float]) -> None:
        if operation == "remove":
            if row in self.rows:
                self.rows.remove(row)
        elif row not in self.rows:
            self.rows.insert(0 if operation == "add" else len(self.rows), row)


@given(OPERATIONS)
def test_a_table_answers_like_a_list_whatever_is_added_and_removed(
    operations: list[tuple[str, int, int]],
) -> None:
    table, model = Table(functor("p", 2)), Model()
    table.find((0,), 0.0)
    table.find((0, 1), (0.0, 0.0))
    for operation, a, b in operations:
        row = (float(a), float(b))
        model.apply(operation, row)
        if operation == "remove":
            if table.get(row) is not None:
                table.remove(row)
        elif table.get(row) is None:
            table.add(row, BY_SELF, last=operation == "last")
    assert [entry for entry, _ in table.entries()] == model.rows
    if table.plain:
        for a in range(5):
            assert list(table.find((0,), float(a))) == [r for r in model.rows if r[0] == a]
            assert list(table.find((0, 1), (float(a), 1.0))) == [r for r in model.rows if r == (a, 1.0)]


class Entry:
    """Stands for a rule or a belief with variables: what is no row."""

    node = None


@given(st.lists(st.tuples(st.sampled_from("arxlRLd"), st.integers(0, 3), st.integers(0, 2)), max_size=30))
def test_candidates_are_in_order_and_miss_nothing_whatever_is_mixed(
    operations: list[tuple[str, int, int]],
) -> None:
    table = Table(functor("p", 2))
    entries = [Entry() for _ in range(4)]
    model: list[object] = []
    for operation, a, b in operations:
        item: object = (float(a), float(b)) if operation in "arxl" else entries[a]
        if operation in "rd" or item in model:
            if item in model:
                model.remove(item)
                table.remove(item)
        else:
            late = operation in "lL"
            model.insert(len(model) if late else 0, item)
            table.add(item, BY_SELF, last=late)
        assert table.plain == all(i.__class__ is tuple for i in (*model, *table.late)) or table.late
        assert table.others == sum(i.__class__ is not tuple for i in table.rows)
    for question in ((1.0, Var()), (Var(), 2.0), (1.0, 2.0), (Var(), Var())):
        asked = tuple(None if a.__class__ is Var else a for a in question)
        found = [e for e, _ in table.candidates(question) if e.__class__ is not tuple or matches(e, asked)]
        assert found == [e for e in model if e.__class__ is not tuple or matches(e, asked)]


def matches(row: object, asked: tuple[object, ...]) -> bool:
    assert isinstance(row, tuple)
    return all(b in (None, a) for a, b in zip(row, asked, strict=True))


def test_taking_out_the_newest_leaves_no_gaps_to_read_over() -> None:
    table = Table(functor("p", 2))
    table.find((0,), 1.0)
    for i in range(1000):
        table.add((1.0, float(i)), BY_SELF)
    for i in range(999, -1, -1):
        assert next(iter(table.find((0,), 1.0))) == (1.0, float(i))
        table.remove((1.0, float(i)))
    assert list(table.find((0,), 1.0)) == []
    table.add((1.0, 5.0), BY_SELF)
    assert list(table.find_items((0,), 1.0)) == [((1.0, 5.0), BY_SELF)]


def test_a_search_reads_what_was_there_before_an_action_in_it_changed_beliefs() -> None:
    base = BeliefBase()
    table = base[functor("p", 1)]
    for i in range(3):
        table.add((float(i),), BY_SELF)
    found = []
    for row in reversed(table.rows):
        base.searching = base.next_call()
        table.remove(row)
        table.add((row[0] + 10,), BY_SELF)
        base.searching = 0
        found.append(row)
    assert found == [(2.0,), (1.0,), (0.0,)]
    assert [row for row, _ in table.entries()] == [(10.0,), (11.0,), (12.0,)]


def test_a_table_that_held_a_rule_is_plain_again_when_it_is_gone() -> None:
    table = Table(atom("p"))
    rule = object()
    table.add((), BY_SELF)
    table.add(rule, ())
    assert not table.plain
    table.remove(rule)
    assert table.plain
