"""What the agents of this game cannot say well in AgentSpeak, in Python.

The agents find it by its name: `mastermind.score(...)` in a program is the function `score` of this file.
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
    """How many pegs of a guess are right, and how many have only the right colour."""
    hits = sum(peg == wanted for peg, wanted in zip(guess, code, strict=True))
    common = sum(min(code.count(colour), guess.count(colour)) for colour in COLOURS)
    right.set(hits)
    misplaced.set(common - hits)


@internal_action
def codes(tried: list[Structure]) -> Iterator[list[Atom]]:
    """Every code that may be the secret one, given the previous guesses: a condition takes them in turn."""
    yield from _possible(tried)


@arithmetic_function
def left(tried: list[Structure]) -> int:
    """How many codes may still be the secret one."""
    return sum(1 for _ in _possible(tried))


@internal_action
async def ponder(agent: Agent, seconds: float) -> None:
    """Think for a while, on the clock of the run: only the intention that calls it waits."""
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
    """Thinks up a secret code, and listens to one player only."""

    def init(self, player: str) -> None:
        """Begin with a code that follows from the seed of the run."""
        self.player = player
        self.add_belief(Literal("secret", ([self.random.choice(COLOURS) for _ in range(LENGTH)],)))

    def soc_acc(self, message: Message) -> bool:
        """Refuse messages from all others."""
        return message.sender == self.player
