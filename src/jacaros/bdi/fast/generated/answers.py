"""Code that goes through answers: loops over them, and what is bound on the way."""

from jacaros.bdi.fast.generated.building import tuple_of
from jacaros.bdi.fast.generated.function import FunctionBuilder
from jacaros.bdi.fast.generated.matching import Then, settle_fresh


def loop_over_answers(fn: FunctionBuilder, generator: str, targets: list[str], then: Then) -> None:
    """A loop over the answers of a generator expression, whose values go to *targets*."""
    if fn.trampoline:
        source, answer = fn.local("g"), fn.local("r")
        fn.line(f"{source} = {generator}")
        with fn.writer.block(f"while ({answer} := (yield {source})) is not None:"):
            if targets:
                fn.line(f"{tuple_of(targets)} = {answer}")
            then()
    else:
        with fn.writer.block(f"for {tuple_of(targets) if targets else '_'} in {generator}:"):
            then()


def loop_binding(fn: FunctionBuilder, generator: str, names: list[str], then: Then) -> None:
    """A loop over answers that bind variables in place."""

    def settled() -> None:
        settle_fresh(fn, names)
        then()

    loop_over_answers(fn, generator if fn.trampoline else f"run({generator}, agent.rule_depth)", [], settled)


def undoing(fn: FunctionBuilder, test: str, names: list[str], then: Then) -> None:
    """A test that may bind variables; the bindings are taken back when the search goes on."""
    mark = fn.local("n")
    fn.line(f"{mark} = len(t)")
    with fn.writer.block(f"if {test}:"):
        settle_fresh(fn, names)
        then()
    fn.line(f"if len(t) > {mark}: undo(t, {mark})")
