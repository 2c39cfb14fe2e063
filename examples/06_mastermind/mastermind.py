"""The parts of the game that are easier to write in Python than in AgentSpeak.

Programs call them by the name of this file: `mastermind.score(...)` is the function `score`.
"""

import asyncio
from collections.abc import Iterator
from itertools import product
from typing import Any

from jacaros import Agent, Atom, Literal, Message, Out, Structure, arithmetic_function, internal_action

COLOURS = [Atom(name) for name in ("black", "blue", "green", "red", "white", "yellow")]
LENGTH = 4


@internal_action
def score(code: list[Atom], guess: list[Atom], right: Out, misplaced: Out) -> None:
    """Count the pegs of a guess that are right, and those with only the right colour."""
    hits = sum(peg == wanted for peg, wanted in zip(guess, code, strict=True))
    common = sum(min(code.count(colour), guess.count(colour)) for colour in COLOURS)
    right.set(hits)
    misplaced.set(common - hits)


@internal_action
def codes(tried: list[Structure]) -> Iterator[list[Atom]]:
    """Yield every code that fits the previous guesses; a context tries them in turn."""
    yield from _possible(tried)


@arithmetic_function
def left(tried: list[Structure]) -> int:
    """Count the codes that fit the previous guesses."""
    return sum(1 for _ in _possible(tried))


@internal_action
async def ponder(agent: Agent, seconds: float) -> None:
    """Wait for some seconds of the run's clock; only the calling intention waits."""
    agent.print("hmm ...")
    await asyncio.sleep(seconds)


def _possible(tried: list[Structure]) -> Iterator[list[Atom]]:
    for code in map(list, product(COLOURS, repeat=LENGTH)):
        if all(_fits(code, *each.arguments) for each in tried):
            yield code


def _fits(code: list[Atom], guess: Any, *answer: object) -> bool:
    right, misplaced = Out(), Out()
    score(code, guess, right, misplaced)  # decorated functions can be called from Python, too
    return answer == (right.value, misplaced.value)


class Keeper(Agent):
    """An agent that chooses a secret code and accepts messages from one player only."""

    def init(self, player: str) -> None:
        """Choose a code; the seed of the run makes it reproducible."""
        self.player = player
        self.add_belief(Literal("secret", ([self.random.choice(COLOURS) for _ in range(LENGTH)],)))

    def soc_acc(self, message: Message) -> bool:
        """Accept messages from the player only."""
        return message.sender == self.player
