"""Reload changed programs, and replace those that agents run."""

from collections.abc import Iterator

from jacaros.agents.language import nodes
from jacaros.agents.language.lowering import format_term
from jacaros.agents.language.nodes import shape
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules.plan_changes import outdated_plans, replace_plans, replace_rules
from jacaros.runtime.mas.agents.lifecycle import AgentLifecycle
from jacaros.runtime.mas.directory import Directory

NOTHING = "no program has changed"


def reload_programs(directory: Directory, lifecycle: AgentLifecycle) -> list[str]:
    """Read the programs of all agents again, and replace plans and rules of changed programs.

    Returns:
        What was replaced, and what could not be, one line each.

    Raises:
        AslError: a program has errors; nothing has been replaced.
    """
    agents = [
        (host.mind, spec)
        for host in directory
        if host.mind is not None
        and (spec := lifecycle.spec(host.name)) is not None
        and spec.source_path.suffix == ".asl"
        and not spec.is_python
    ]
    programs = lifecycle.programs.read_again([spec for _, spec in agents])
    lines: list[str] = []
    for (mind, _), program in zip(agents, programs, strict=True):
        if _texts(program) != _texts(mind.program):
            lines += _report(mind, program)
            _replace_soon(mind, program, lifecycle)
    return lines or [NOTHING]


def _texts(program: nodes.Program) -> set[tuple[str, str]]:
    """Return names and texts of the files of a program. The project's declarations are not in a file."""
    clauses = (*program.plans, *program.beliefs, *program.goals)
    return {(clause.span.file.name, clause.span.file.text) for clause in clauses if clause.span is not None}


def _replace_soon(mind: Mind, program: nodes.Program, lifecycle: AgentLifecycle) -> None:
    """Replace the program; before the next step of an agent that has its turn now."""
    if mind.running:
        mind.do_soon(lambda _: _replace(mind, program, lifecycle))
    else:
        _replace(mind, program, lifecycle)
    mind.architecture.ready()


def _replace(mind: Mind, program: nodes.Program, lifecycle: AgentLifecycle) -> None:
    mind.register_functions(program.functions)
    replace_rules(mind, mind.program.beliefs, program.beliefs)
    mind.program = program
    replace_plans(mind, lifecycle.plans_of(program))


def _report(mind: Mind, new: nodes.Program) -> list[str]:
    old, agent = mind.program, f"agent {mind.name}"
    before, after = {shape(plan) for plan in old.plans}, {shape(plan) for plan in new.plans}
    gone = len(before - after)
    return [
        (
            f"{agent}: {gone} plan{'s' if gone != 1 else ''} removed, {len(after - before)} new, "
            f"{len(before & after)} unchanged"
        ),
        *(
            f"{agent}: intention {number} continues with its old plan {_place(plan.node)}"
            for number, plan in outdated_plans(mind, new.plans)
        ),
        *(f"{agent}: the new initial {what} is not adopted" for what in _new_facts(old, new)),
    ]


def _new_facts(old: nodes.Program, new: nodes.Program) -> Iterator[str]:
    """Return the initial beliefs and goals that only the new program has. Rules are replaced."""
    for what, before, after in (("belief", old.beliefs, new.beliefs), ("goal", old.goals, new.goals)):
        known = {shape(node) for node in before}
        for node in after:
            if not isinstance(node, nodes.Rule) and shape(node) not in known:
                yield f"{what} {format_term(node)}"


def _place(node: nodes.Plan) -> str:
    place = "" if node.span is None else f" ({node.span.file.name}:{node.span.line})"
    return f"{format_term(node.trigger)}{place}"
