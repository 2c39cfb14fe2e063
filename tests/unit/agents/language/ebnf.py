"""Read a grammar in EBNF, write random strings of it, and recognise strings of it."""

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from random import Random

Symbol = tuple[bool, str]
"""Whether it is a terminal, and its text or name."""
_WORD = re.compile(r'\s*(?:\(\*.*?\*\)\s*)*("[^"]*"|\w+|[][{}()|=;])', re.DOTALL)


@dataclass
class Grammar:
    """Alternatives by the name of a rule; options, repetitions and groups are rules with names of their own.

    A name without a rule is a class of tokens.
    """

    rules: dict[str, list[list[Symbol]]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.costs: dict[str, int] = {}

    def settle(self) -> None:
        """Compute the length of the shortest derivation of each rule."""
        self.costs = dict.fromkeys(self.rules, 1_000_000)
        for _ in self.rules:
            for name, alternatives in self.rules.items():
                self.costs[name] = 1 + min(map(self.cost, alternatives))

    def cost(self, alternative: Sequence[Symbol]) -> int:
        """The length of the shortest derivation of an alternative."""
        return sum(self.costs.get(name, 1) for _, name in alternative)


def read(text: str) -> Grammar:
    """Read a grammar."""
    return _Reader(_WORD.findall(text)).grammar()


class _Reader:
    def __init__(self, words: list[str]) -> None:
        self._words, self._at = words, 0
        self._grammar = Grammar()

    def grammar(self) -> Grammar:
        while self._at < len(self._words):
            name = self._next()
            assert self._next() == "="
            self._grammar.rules[name] = self._alternatives()
            assert self._next() == ";"
        self._grammar.settle()
        return self._grammar

    def _next(self) -> str:
        self._at += 1
        return self._words[self._at - 1]

    def _alternatives(self) -> list[list[Symbol]]:
        found = [self._sequence()]
        while self._words[self._at] == "|":
            self._next()
            found.append(self._sequence())
        return found

    def _sequence(self) -> list[Symbol]:
        found: list[Symbol] = []
        while (word := self._words[self._at]) not in "|;)]}":
            self._next()
            if word in "([{":
                found.append((False, self._made(word)))
            else:
                found.append((True, word[1:-1]) if word[0] == '"' else (False, word))
        return found

    def _made(self, bracket: str) -> str:
        name = f"{bracket}{self._at}"
        inner = self._alternatives()
        self._next()
        if bracket == "{":
            inner = [[*each, (False, name)] for each in inner]
        self._grammar.rules[name] = inner if bracket == "(" else [[], *inner]
        return name


def written(grammar: Grammar, random: Random, start: str, room: int) -> list[str]:
    """Return the tokens of a random string of a rule: texts, and names of classes of tokens.

    Args:
        grammar: the grammar.
        random: makes the choices.
        start: the rule.
        room: number of choices that are free; afterwards, the shortest alternatives are taken.
    """
    tokens: list[str] = []
    todo: list[Symbol] = [(False, start)]
    while todo:
        terminal, name = todo.pop()
        alternatives = None if terminal else grammar.rules.get(name)
        if alternatives is None:
            tokens.append(name)
            continue
        room -= 1
        alternative = random.choice(alternatives) if room > 0 else min(alternatives, key=grammar.cost)
        todo.extend(reversed(alternative))
    return tokens


class Recogniser:
    """Decides whether strings belong to a grammar without left recursion."""

    def __init__(self, grammar: Grammar, start: str) -> None:
        self._rules: Mapping[str, list[list[Symbol]]] = grammar.rules
        self._start = start

    def accepts(self, tokens: Sequence[Collection[str]]) -> bool:
        """Return whether a string belongs to the grammar; each token is given by all terminals that it matches."""
        known: dict[tuple[str, int], set[int]] = {}

        def ends(symbol: Symbol, place: int) -> set[int]:
            """Where derivations of a symbol that begin at a place may end."""
            terminal, name = symbol
            if terminal or name not in self._rules:
                return {place + 1} if place < len(tokens) and name in tokens[place] else set()
            if (name, place) not in known:
                found: set[int] = set()
                for alternative in self._rules[name]:
                    places = {place}
                    for each in alternative:
                        places = set().union(*(ends(each, at) for at in places))
                    found |= places
                known[name, place] = found
            return known[name, place]

        return len(tokens) in ends((False, self._start), 0)
