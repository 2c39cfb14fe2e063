"""Agent options, named as in Jason's project files."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Options:
    """How an agent handles its events.

    Attributes:
        events: what happens to external events without a plan: ``discard``; ``requeue``, they wait until there is one;
            ``retrieve``, the selection function chooses among no plans, and selects none by default.
        new_focus: belief changes of plans are handled as intentions of their own (``intBels=newFocus``).
        tail_calls: a plan whose last formula calls its own goal again is replaced by the new one (``tro``).
        verbose: how much is logged about the agent besides its output: 0 only problems, 2 details as well.
        percept_interval: percepts and messages are taken in every that number of cycles (``nrcbp``), and when the agent
            is idle.
        urgency: names of events, with the urgency of all plans for them (`jacaros.bdi.rules.urgency`).
        rule_depth: maximum number of rules and conditions open at the same time in one search; one more fails it
            (some kilobytes each).
        goal_depth: maximum number of plans on the stack of an intention; a goal that exceeds it fails (a quarter
            of a kilobyte each, and what the plans hold).
        search_limit: maximum number of calls of rules and answers of internal actions in one cycle; 0 for no limit.
        belief_limit: maximum number of beliefs.
        event_limit: maximum number of waiting events.
        intention_limit: maximum number of intentions.
        mailbox_limit: maximum number of waiting messages.
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
