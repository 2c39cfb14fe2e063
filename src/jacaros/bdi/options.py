"""Agent options, named as in Jason's project files."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Options:
    """How an agent handles its events.

    Attributes:
        events: what becomes of external events without a plan: ``discard`` or ``requeue``.
        new_focus: belief changes of plans are handled as intentions of their own (``intBels=newFocus``).
        tail_calls: a plan whose last formula calls its own goal again is replaced by the new one (``tro``).
        verbose: 0 prints only what the program prints, 2 tells of every step.
    """

    events: str = "discard"
    new_focus: bool = False
    tail_calls: bool = True
    verbose: int = 1
