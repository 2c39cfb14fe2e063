"""Agent options, named as in Jason's project files."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Options:
    """How an agent handles its events.

    Attributes:
        events: what becomes of external events without a plan: ``discard``; ``requeue``, they wait until there is one;
            ``retrieve``, the choice among no plans is left to the selection function, and is none without one.
        new_focus: belief changes of plans are handled as intentions of their own (``intBels=newFocus``).
        tail_calls: a plan whose last formula calls its own goal again is replaced by the new one (``tro``).
        verbose: what people are told of the agent besides what it prints: 0 only trouble, 2 details as well.
        percept_interval: percepts and messages are looked at every so many cycles (``nrcbp``), and when there is nothing
            else to do.
        urgency: names of events, with the urgency of all plans for them (`jacaros.bdi.rules.urgency`).
        rule_depth: how many rules and conditions may be open at the same time in one search; one more and it fails
            (some kilobytes each).
        goal_depth: how many plans may be on the stack of an intention; a goal that would be one more fails (a quarter
            of a kilobyte each, and what the plans hold).
        search_limit: how many rules may be called, and answers of internal actions taken, in one cycle; 0 for any number.
        belief_limit: how many beliefs there may be.
        event_limit: how many events may wait.
        intention_limit: how many intentions there may be.
        mailbox_limit: how many messages may wait.
        plans_from_others: whether plans of messages (``tellHow``) are added.
    """

    events: str = "discard"
    new_focus: bool = False
    tail_calls: bool = True
    rule_depth: int = 500_000
    goal_depth: int = 1_000_000
    search_limit: int = 0
    belief_limit: int = 10_000_000
    event_limit: int = 1_000_000
    intention_limit: int = 100_000
    mailbox_limit: int = 1_000_000
    verbose: int = 1
    percept_interval: int = 1
    urgency: tuple[tuple[str, int], ...] = ()
    plans_from_others: bool = True
