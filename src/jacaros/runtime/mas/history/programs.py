"""Records of programs: source files, and the plans of each agent by number."""

from collections.abc import Iterator, Sequence

from jacaros.agents.checks.thresholds import Argument, Threshold, thresholds
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import SourceFile
from jacaros.agents.language.lowering import format_term
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules.failure_reason import unbracketed
from jacaros.agents.mind.state.plan import Plan, Rule, every_plan
from jacaros.agents.mind.state.plan_library import ProgramPlans
from jacaros.agents.terms.text import text
from jacaros.look.records import records
from jacaros.look.records.records import RecordSink
from jacaros.look.records.words import named

_Described = tuple[list[records.PlanRecord], list[records.ThresholdRecord]]


class ProgramRecords:
    """Records the programs of agents. Agents with the same program share the texts.

    Args:
        tell: takes the records.
    """

    def __init__(self, tell: RecordSink) -> None:
        self._tell = tell
        self._files: dict[str, str] = {}
        self._known: dict[int, tuple[ProgramPlans, _Described]] = {}

    def begin(self, mind: Mind) -> "PlanNumbers":
        """Record the program of an agent. Return the numbers of its plans."""
        numbers = PlanNumbers(mind.library.program.plans)
        self.record(mind, numbers)
        return numbers

    def record(self, mind: Mind, numbers: "PlanNumbers") -> None:
        """Record the current plans and rules of an agent."""
        library, rules = mind.library, list(_rules(mind))
        if library.plans is library.program.plans and numbers.count_from_one(library.plans):
            plans, compared = self._of_program(library.program, rules)
        else:
            plans, compared = _described(library.plans, rules, numbers)
        for span in (each.span for each in (*(plan.node for plan in library.plans), *rules)):
            if span is not None:
                self._source(span.file)
        self._tell(records.ProgramRecord(mind.name, plans, [_written(rule) for rule in rules], compared))

    def _of_program(self, program: ProgramPlans, rules: Sequence[nodes.Rule]) -> _Described:
        known = self._known.get(id(program))
        if known is None:
            known = program, _described(program.plans, rules, PlanNumbers(program.plans))
            self._known[id(program)] = known
        return known[1]

    def _source(self, file: SourceFile) -> None:
        if self._files.get(file.name) != file.text:
            self._files[file.name] = file.text
            self._tell(records.SourceRecord(file.name, file.text))


class PlanNumbers(dict[Plan, int]):
    """The numbers of the plans of an agent, in the order of its program. Plans added later follow."""

    def __init__(self, plans: Sequence[Plan]) -> None:
        super().__init__()
        for plan in every_plan(plans):
            self[plan]  # numbered on access

    def count_from_one(self, plans: Sequence[Plan]) -> bool:
        """Return whether these plans have the first numbers. Those of a reloaded program follow those of the old one."""
        return not plans or self[plans[0]] == 1

    def __missing__(self, plan: Plan) -> int:
        self[plan] = number = len(self) + 1
        return number


def _described(plans: Sequence[Plan], rules: Sequence[nodes.Rule], numbers: PlanNumbers) -> _Described:
    every = list(every_plan(plans))
    known = {id(plan.node): numbers[plan] for plan in every}
    compared: list[records.ThresholdRecord] = []
    for each in thresholds([*(plan.node for plan in every), *rules]):
        record = _threshold(each, known.get(id(each.clause)))
        if record not in compared:
            compared.append(record)
    return [_plan(plan, numbers[plan]) for plan in every], compared


def _threshold(found: Threshold, plan: int | None) -> records.ThresholdRecord:
    (name, _, place), clause = found.belief, found.clause
    record = records.ThresholdRecord(name, place, found.operator, plan=plan)
    if isinstance(found.value, Argument):
        record.other, record.other_argument = found.value.name, found.value.place
    else:
        record.value = found.value
    if isinstance(clause, nodes.Rule):
        record.rule = clause.head.functor
    return record


def _plan(plan: Plan, number: int) -> records.PlanRecord:
    node, span = plan.node, plan.node.span
    context = "" if node.context is None else _written(node.context)
    first, last = (0, 0) if span is None else (span.line, span.end_line)
    trigger = named(format_term(node.trigger))
    return records.PlanRecord(number, trigger, text(plan.label), context, plan.file, first, last)


def _written(node: nodes.Node) -> str:
    """Return a formula or rule as written, on one line."""
    span = node.span
    if span is None:
        return unbracketed(format_term(node))
    lines = list(span.file.lines[span.line - 1 : span.end_line])
    lines[-1] = lines[-1][: span.end_column - 1]
    lines[0] = lines[0][span.column - 1 :]
    return " ".join(line.strip() for line in lines)


def _rules(mind: Mind) -> Iterator[nodes.Rule]:
    """Return the rules of the program, which an agent that has not begun does not have yet, and those added at run time."""
    yield from (each for each in mind.program.beliefs if isinstance(each, nodes.Rule))
    for table in list(mind.beliefs.values()):
        if not table.plain:
            for entry, _ in table.entries():
                if isinstance(entry, Rule) and not entry.of_program:
                    yield entry.written
