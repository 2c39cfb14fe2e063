"""Failures at which a run stops, with the stack of the intention before the failure is handled."""

from collections.abc import Sequence
from dataclasses import dataclass

from jacaros.agents.language import nodes
from jacaros.agents.mind.rules.failure_reason import FailureReason, why
from jacaros.agents.mind.state.intention import Frame, Intention


@dataclass(frozen=True)
class Failed:
    """A failure at which a run stopped.

    Attributes:
        agent: name of the agent.
        intention: number of the intention, which may be over.
        kinds: its kinds, see `jacaros.runtime.mas.debugging.breakpoints.FailureBreakpoint`.
        error: id of the error, such as ``no_applicable``.
        message: the reason, in words.
        frames: the stack before the failure was handled.
        line: line of the step that failed; 0 if it is unknown.
    """

    agent: str
    intention: int
    kinds: tuple[str, ...]
    error: str
    message: str
    frames: Sequence[Frame]
    line: int


def failed(agent: str, intention: Intention, reason: FailureReason) -> Failed:
    """Describe a failure before it is handled."""
    place = reason.place
    span = place.span()
    return Failed(
        agent,
        intention.id,
        _kinds(reason),
        reason.error(),
        why(reason),
        [list(frame) for frame in intention.frames],  # handling the failure releases bindings
        0 if span is None else span.line,
    )


def _kinds(reason: FailureReason) -> tuple[str, ...]:
    if reason.place.unplanned is not None and reason.known_error().startswith("no_"):
        return "goal", "plan"
    info = reason.place.info
    acted = info is not None and isinstance(info.node, nodes.ExternalAction)
    return ("goal", "operation") if acted else ("goal",)
