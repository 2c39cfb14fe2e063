"""Read a grammar in EBNF, write random strings of it, and recognise strings of it (Earley's algorithm)."""

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

    def nullable(self) -> set[str]:
        """The rules that derive the empty string."""
        found: set[str] = set()
        while True:
            more = {
                name
                for name, alternatives in self.rules.items()
                if any(all(not t and n in found for t, n in each) for each in alternatives)
            }
            if more == found:
                return found
            found = more


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


_Item = tuple[str, int, int, int]
"""A rule, its alternative, the position in it, and where it began."""


class Recogniser:
    """Decides whether strings belong to a grammar."""

    def __init__(self, grammar: Grammar, start: str) -> None:
        self._rules: Mapping[str, list[list[Symbol]]] = grammar.rules
        self._nullable, self._start = grammar.nullable(), start

    def accepts(self, tokens: Sequence[Collection[str]]) -> bool:
        """Return whether a string belongs to the grammar; each token is given by all terminals that it matches."""
        chart: list[dict[_Item, None]] = [{} for _ in range(len(tokens) + 1)]
        chart[0] = {(self._start, number, 0, 0): None for number in range(len(self._rules[self._start]))}
        for place, token in enumerate([*tokens, ()]):
            self._close(chart, place)
            if place < len(tokens):
                chart[place + 1] = {
                    (name, number, dot + 1, begin): None
                    for name, number, dot, begin in chart[place]
                    if (symbol := self._after(name, number, dot)) is not None
                    and (symbol[0] or symbol[1] not in self._rules)
                    and symbol[1] in token
                }
        return any(
            item[0] == self._start and item[3] == 0 and self._after(*item[:3]) is None for item in chart[-1]
        )

    def _after(self, name: str, number: int, dot: int) -> Symbol | None:
        alternative = self._rules[name][number]
        return alternative[dot] if dot < len(alternative) else None

    def _close(self, chart: list[dict[_Item, None]], place: int) -> None:
        """Add what follows without another token."""
        items = chart[place]
        todo = list(items)
        while todo:
            name, number, dot, begin = todo.pop()
            symbol = self._after(name, number, dot)
            new: list[_Item] = []
            if symbol is None:
                new = [
                    (above, n, d + 1, b)
                    for above, n, d, b in chart[begin]
                    if self._after(above, n, d) == (False, name)
                ]
            elif not symbol[0] and symbol[1] in self._rules:
                new = [(symbol[1], n, 0, place) for n in range(len(self._rules[symbol[1]]))]
                if symbol[1] in self._nullable:
                    new.append((name, number, dot + 1, begin))
            for item in new:
                if item not in items:
                    items[item] = None
                    todo.append(item)
