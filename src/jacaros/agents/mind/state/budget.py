"""Budgets: how much of something an agent may hold at the same time (agent options ``belief_limit``, ``event_limit``,
``intention_limit`` and ``mailbox_limit``), and how much a question about it may search.

A program that never stops growing loses some of its goals, with a reason, instead of exhausting the memory of the run.
"""

from dataclasses import dataclass
from typing import Any, Final

from jacaros.agents.mind.state.plan import Failure
from jacaros.agents.terms.values import String, atom, functor
from jacaros.runtime.files.texts import is_worth_a_line

# Agent options, named as in Jason's project files.


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
        urgency: names of events, with the urgency of all plans for them (`jacaros.agents.mind.rules.urgency`).
        rule_depth: maximum number of rules and conditions open at the same time in one search; one more fails it
            (some kilobytes each).
        goal_depth: maximum number of plans on the stack of an intention; a goal that exceeds it fails (a quarter
            of a kilobyte each, and what the plans hold).
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
    belief_limit: int = 10_000_000
    event_limit: int = 1_000_000
    intention_limit: int = 100_000
    mailbox_limit: int = 1_000_000
    verbose: int = 1
    percept_interval: int = 1
    urgency: tuple[tuple[str, int], ...] = ()
    plans_from_others: bool = True


_ERROR, _ERROR_MSG = functor("error", 1), functor("error_msg", 1)


_COUNTED: Final = {
    "belief_limit": "beliefs",
    "event_limit": "events",
    "intention_limit": "intentions",
    "mailbox_limit": "messages",
}
"""What each option limits."""


def budgets(holder: Any) -> dict[str, "Budget"]:
    """The budgets of an agent, by the names of the options."""
    return {option: Budget(holder, what, option) for option, what in _COUNTED.items()}


class Budget:
    """Refuses what exceeds a limit.

    Args:
        holder: the mind that has the budget.
        what: what is counted, in the plural.
        option: the agent option that sets the limit; also the name of the error.

    Attributes:
        refusals: how many items from outside were refused.
        losses: how many intentions were lost because a step was refused one.
    """

    def __init__(self, holder: Any, what: str, option: str) -> None:
        self._holder, self._what, self._option = holder, what, option
        self.refusals = self.losses = 0

    def refuse(self, held: int, details: str = "") -> None:
        """Refuse one more item: the running step fails; without one, log it on the 1st, 10th, 100th … occurrence.

        Args:
            held: how many items there are.
            details: more about them, for the message.

        Raises:
            Failure: a step is running.
        """
        if self._holder.current is not None:
            raise self.failure(held, details)
        self.refusals += 1
        if is_worth_a_line(self.refusals):
            count = "" if self.refusals == 1 else f" ({self.refusals} so far)"
            text = f"refusing {self._what} from outside{count}: {self._message(held, details)}"
            self._holder.architecture.log("error", text)

    def note_loss(self) -> int:
        """Count an intention that was lost; the number on the 1st, 10th, 100th … occurrence, else 0."""
        self.losses += 1
        return self.losses if is_worth_a_line(self.losses) else 0

    def failure(self, held: int, details: str = "") -> Failure:
        """The failure of a step that asks for one more item."""
        message = String(self._message(held, details))
        return Failure((_ERROR, atom(self._option)), (_ERROR_MSG, message))

    def _message(self, held: int, details: str) -> str:
        return f"there are {held} {self._what} (option {self._option}){details}"


class SearchLimit(Exception):
    """A search has used the budget up."""


class SearchBudget:
    """Counts what a question does: calls of rules, and answers of internal actions.

    Args:
        limit: how many there may be.
    """

    __slots__ = ("_left", "limit")

    def __init__(self, limit: int) -> None:
        self.limit = self._left = limit

    def spend(self) -> None:
        """A rule is called, or an internal action gives an answer.

        Raises:
            SearchLimit: that is one too many.
        """
        self._left -= 1
        if self._left < 0:
            raise SearchLimit(f"the search takes more than {self.limit} rules and answers")
