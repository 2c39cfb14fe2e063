"""Code for the control statements of plan bodies: ``if``, ``while``, ``for`` and the two ways to fork.

A variable that gets its value on one branch only may have none afterwards; what a round of a loop binds, the next round
finds unbound.
"""

from jacaros.asl import nodes
from jacaros.asl.walk import names_in, nodes_in
from jacaros.bdi.fast.generated.body_compiler import BodyCompiler, StepWriter, head
from jacaros.bdi.fast.generated.building import tuple_of
from jacaros.bdi.fast.generated.conditions import question
from jacaros.bdi.fast.generated.function import FrameLayout, FunctionBuilder
from jacaros.bdi.state.plan import StepInfo
from jacaros.terms.substitution import ATOMIC


def _if(compiler: BodyCompiler, step: nodes.If, name: str, next_name: str) -> None:
    then_name, else_name = compiler.name(), compiler.name()
    has_else = step.otherwise is not None and bool(step.otherwise.steps)
    fn = compiler.begin(step)
    first_then = then_name if step.then.steps else next_name
    first_else = else_name if has_else else next_name
    with fn.writer.block(head(name)):
        fn.line("t = agent.trail")
        fn.load(compiler.frame, names_in(step.condition))
        bound = compiler.success(fn, step.condition, first_then)
        fn.line("if t: undo(t, 0)")
        fn.line(f"frame[0] = {first_else}")
    compiler.unit.add(fn.writer)
    before = dict(compiler.frame.states)
    compiler.learn(bound)
    compiler.branch(step.then.steps, then_name, next_name)
    after_then = dict(compiler.frame.states)
    compiler.frame.states = dict(before)
    if has_else:
        assert step.otherwise is not None
        compiler.branch(step.otherwise.steps, else_name, next_name)
    compiler.frame.states = _joined(after_then, compiler.frame.states)


def _joined(left: dict[str, str], right: dict[str, str]) -> dict[str, str]:
    """What is known after either of two branches."""
    return {
        name: "set" if left.get(name) == right.get(name) == "set" else "maybe"
        for name in dict.fromkeys([*left, *right])
    }


def _while(compiler: BodyCompiler, step: nodes.While, name: str, next_name: str) -> None:
    frame = compiler.frame
    test_name, first = compiler.name(), compiler.name()
    enter = compiler.begin(step)
    with enter.writer.block(head(name)):
        loop = _enter_loop(compiler, enter, step)
        enter.line(f"return {test_name}(agent, frame)")
    compiler.unit.add(enter.writer)
    entry = dict(frame.states)
    compiler.infos[test_name] = StepInfo(step, next_name)
    fn = compiler.begin(step)
    with fn.writer.block(head(test_name)):
        fn.line("t = agent.trail")
        _begin_round(compiler, fn, step, loop)
        fn.load(frame, names_in(step.condition))
        bound = compiler.success(fn, step.condition, first if step.body.steps else test_name)
        fn.line("if t: undo(t, 0)")
        fn.line(f"frame[0] = {next_name}")
    compiler.unit.add(fn.writer)
    compiler.learn(bound)
    compiler.branch(step.body.steps, first, test_name)
    frame.states = entry


def _for(compiler: BodyCompiler, step: nodes.For, name: str, next_name: str) -> None:
    frame = compiler.frame
    round_name, first = compiler.name(), compiler.name()
    enter = compiler.begin(step)
    enter.snapshot = True
    with enter.writer.block(head(name)):
        loop = _enter_loop(compiler, enter, step)
        enter.line("t = Trail()")
        enter.line("t.serial = agent.trail.serial")
        new = [n for n in names_in(step.condition) if n not in enter.values]
        used = [n for n in new if n in frame.slots]
        call = question(enter, step.condition, used)
        enter.line(f"frame[{loop}].answers = Remaining({call})")
        enter.line(f"return {round_name}(agent, frame)")
    compiler.unit.add(enter.writer)
    entry = dict(frame.states)
    compiler.infos[round_name] = StepInfo(step, next_name)
    fn = compiler.begin(step)
    with fn.writer.block(head(round_name)):
        _begin_round(compiler, fn, step, loop)
        if used:
            fn.line("if loop.round: release(loop.round)")
        targets = tuple_of([f"frame[{frame.slots[n]}]" for n in used]) if used else "_"
        with fn.writer.block(f"for {targets} in loop.answers:"):
            if used:
                values = tuple_of(["None", *(f"frame[{frame.slots[n]}]" for n in used)])
                fn.line(f"loop.round = free_variables({values}) if {_any_open(frame, used)} else ()")
            fn.line(f"frame[0] = {first if step.body.steps else round_name}")
            fn.line("return None")
        fn.line(f"frame[{loop}] = None")
        fn.line(f"frame[0] = {next_name}")
    compiler.unit.add(fn.writer)
    compiler.learn(used)
    compiler.branch(step.body.steps, first, round_name)
    frame.states = entry


def _begin_round(compiler: BodyCompiler, fn: FunctionBuilder, step: nodes.Node, loop: int) -> None:
    """What `Loop.begin_round` does, but for the variables that the last round of a ``for`` brought."""
    fn.line(f"loop = frame[{loop}]")
    fn.line("if loop.free: release(loop.free)")
    for place in _inner(compiler, step):
        fn.line(f"frame[{place}] = None")


def _inner(compiler: BodyCompiler, step: nodes.Node) -> list[int]:
    """Places of the variables that get their first value inside a loop: they have none when a round begins."""
    frame = compiler.frame
    return [frame.slots[n] for n in names_in(step) if n not in frame.states and n in frame.slots]


def _free_at_entry(compiler: BodyCompiler) -> list[str]:
    """Variables that a loop has to give back as they were: those that may hold a `Var` at its beginning."""
    return [name for name, state in compiler.frame.states.items() if state]


def _enter_loop(compiler: BodyCompiler, fn: FunctionBuilder, step: nodes.Node) -> int:
    """Remember which variables are free before a loop; returns the place of the `Loop`."""
    frame = compiler.frame
    names = _free_at_entry(compiler)
    fn.load(frame, names)
    loop = frame.hidden_slot()
    # `free_variables` takes the first element of a tuple for a functor.
    # Variables that a body made at run time shares with its plan.
    shared = [fn.constant(c.value) for c in nodes_in(nodes.Constant, step) if c.value.__class__ not in ATOMIC]
    values = tuple_of(["None", *(f"frame[{frame.slots[n]}]" for n in names), *shared])
    test = "True" if shared else _any_open(frame, names)
    inner = tuple_of([str(place) for place in _inner(compiler, step)])
    fn.line(f"frame[{loop}] = Loop(free_variables({values}) if {test} else (), {inner})")
    return loop


def _any_open(frame: FrameLayout, names: list[str]) -> str:
    """A test whether any of the variables may hold something unbound."""
    tests = [f"frame[{frame.slots[n]}].__class__ not in ATOMIC" for n in names]
    return " or ".join(tests) if tests else "False"


def _fork(compiler: BodyCompiler, step: nodes.Fork, name: str, next_name: str) -> None:
    frame = compiler.frame
    names = [compiler.name() for _ in step.branches]
    fn = compiler.begin(step)
    with fn.writer.block(head(name)):
        firsts = [n if b.steps else "join_branch" for n, b in zip(names, step.branches, strict=True)]
        fn.line(f"return agent.fork({step.operator!r}, frame, {tuple_of(firsts)}, {next_name})")
    compiler.unit.add(fn.writer)
    before = dict(frame.states)
    joined = dict(before)
    for branch_name, branch in zip(names, step.branches, strict=True):
        frame.states = dict(before)
        compiler.branch(branch.steps, branch_name, "join_branch")
        for variable in frame.states:
            joined.setdefault(variable, "maybe")
    frame.states = joined


STATEMENTS: dict[type, StepWriter] = {
    nodes.If: _if,
    nodes.While: _while,
    nodes.For: _for,
    nodes.Fork: _fork,
}
