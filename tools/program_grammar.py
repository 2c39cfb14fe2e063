"""Programs generated from the grammar of the language: valid, however strange.

All choices come from one generator, so that a number determines a program, and Hypothesis can shrink it.
"""

from collections.abc import Callable
from random import Random

ATOMS = ("a", "b", "g", "p", "q", "begin", "end", "'quoted one'", "self", "true", "false", "x.y", "nil_1")
FUNCTORS = ("f", "g", "p", "q", "source", "'Q'")
VARIABLES = ("X", "Y", "Z", "Long_Name9", "_", "_U", "_12V")
NUMBERS = ("0", "1", "2", "12", ".5", "1.5", "1e3", "1.5E-3", "2147483648", "1e308", "1e400")
STRINGS = ('""', '"s"', r'"a\nb"', r'"\""', '"日本 é"', '"//no comment"')
RELATIONS = ("<", "<=", ">", ">=", "==", "\\==", "=", "=..")
ARITHMETIC = ("+", "-", "*", "/", " div ", " mod ", "**")
CHANGES = ("+", "-", "-+", "++", "--", "+<", "+>")
ONE_ARGUMENT = (".print", ".ground", ".atom", ".list", ".desire", ".intend", ".abolish", ".belief", ".fail")
GOAL_CONTROL = (
    *(".drop_intention", ".drop_desire", ".drop_event", ".succeed_goal", ".fail_goal", ".suspend"),
    *(".resume", ".drop_future_intention"),
)
PATTERNS = ("dg(g)", "bdg(g)", "ebdg(g)", "mg(p(1))", "bc(g)", "smc(g, q)", "rc(g, q)", "omc(g, p, q)")


class Grammar:
    """Generates parts of programs.

    Args:
        random: source of choices.
        depth: maximum nesting of terms, formulae and statements.
    """

    def __init__(self, random: Random, depth: int = 4) -> None:
        self.random = random
        self.depth = depth
        self._labels = 0

    def program(self) -> str:
        """A whole program."""
        makers = (self.belief, self.rule, self.goal, self.plan, self.plan, self.plan, self.directive)
        return "".join(self.random.choice(makers)() for _ in range(self.random.randint(1, 9)))

    # clauses

    def belief(self) -> str:
        """A belief."""
        return self.literal(2) + ".\n"

    def rule(self) -> str:
        """A rule."""
        return f"{self.literal(2)} :- {self.formula(self.depth)}.\n"

    def goal(self) -> str:
        """An initial goal."""
        return f"!{self.literal(2)}.\n"

    def directive(self) -> str:
        """A directive, or a block of clauses in one."""
        random = self.random
        if random.random() < 0.3:
            return "{ namespace(n" + random.choice(("", ", local", ", global")) + ") }\n"
        begin = random.choice((*PATTERNS, "namespace(m)"))
        return f"{{ begin {begin} }}\n{''.join(self.plan() for _ in range(random.randint(0, 3)))}{{ end }}\n"

    def plan(self) -> str:
        """A plan, with sub-plans at times."""
        text = self._plan(self.depth) + ".\n"
        if self.random.random() < 0.1:
            text += "{ " + "".join(f"{self._plan(2)}.\n" for _ in range(self.random.randint(1, 2))) + "}\n"
        return text

    def _plan(self, depth: int, kind: str | None = None) -> str:
        random = self.random
        text = self._label() + self.trigger(kind)
        if random.random() < 0.5:
            text += f" : {self.formula(depth)}"
        if random.random() < 0.1:
            text += f" <: {self.formula(1)}"
        return text + (f" <- {self.body(depth)}" if random.random() < 0.9 else "")

    def _label(self) -> str:
        if self.random.random() > 0.2:
            return ""
        self._labels += 1
        annotations = self.random.choice(("", "", "[atomic]", "[all_unifs]", "[priority(3), atomic]"))
        return f"@l{self._labels}{annotations} "

    def trigger(self, kind: str | None = None) -> str:
        """A trigger, of a *kind* or any."""
        sign = self.random.choice(("+", "+", "+", "-"))
        if kind is None:
            kind = self.random.choice(("!", "!", "!", "", "", "?"))
        if self.random.random() < 0.05:
            sign, kind = "^", "!"
        if self.random.random() < 0.1:
            return sign + kind + self.random.choice(("X", "X[error(E)]", "P"))
        return sign + kind + self.literal(2)

    # terms

    def term(self, depth: int) -> str:
        """Any term."""
        makers: tuple[Callable[[int], str], ...] = (self._simple,)
        if depth > 0:
            makers = (
                *(self._simple, self._simple, self.literal, self.literal, self._list, self._sum),
                *(self._variable, self._braces, self._function),
            )
        return self.random.choice(makers)(depth - 1)

    def _simple(self, _: int) -> str:
        return self.random.choice(self.random.choice((ATOMS, VARIABLES, NUMBERS, STRINGS)))

    def _variable(self, depth: int) -> str:
        name = self.random.choice(VARIABLES)
        return name + (self._annotations(depth) if self.random.random() < 0.2 else "")

    def literal(self, depth: int) -> str:
        """A literal that may be believed."""
        random = self.random
        text = "~" if random.random() < 0.1 else ""
        if random.random() < 0.05:
            text = random.choice(("n::", "default::", "this_ns::")) + text
        if random.random() < 0.3:
            text += random.choice(("a", "g", "p", "q"))
        else:
            arguments = ",".join(self.term(depth - 1) for _ in range(random.randint(1, 3)))
            text += f"{random.choice(FUNCTORS)}({arguments})"
        return text + (self._annotations(depth) if random.random() < 0.15 else "")

    def _annotations(self, depth: int) -> str:
        items = ",".join(self._annotation(depth) for _ in range(self.random.randint(1, 3)))
        return f"[{items}{'|T' if self.random.random() < 0.2 else ''}]"

    def _annotation(self, depth: int) -> str:
        random = self.random
        simple = ("a", "source(self)", "source(percept)", "source(bob)[source(eve)]", "source(S)", "X", "1")
        return random.choice(simple) if random.random() < 0.8 else self.term(min(depth, 1))

    def _list(self, depth: int) -> str:
        items = ",".join(self._element(depth) for _ in range(self.random.randint(0, 3)))
        tail = "|" + self.random.choice(("T", "[b|T]", "[]")) if self.random.random() < 0.2 else ""
        return f"[{items}{tail}]"

    def _element(self, depth: int) -> str:
        return self.term(depth)

    def _number(self, depth: int) -> str:
        if depth > 0 and self.random.random() < 0.4:
            return self._sum(depth - 1)
        return self.random.choice(self.random.choice((VARIABLES[:4], NUMBERS)))

    def _sum(self, depth: int) -> str:
        random = self.random
        if random.random() < 0.2:
            return f"-{self._number(0)}"
        text = f"{self._number(depth)}{random.choice(ARITHMETIC)}{self._number(depth)}"
        return f"({text})" if random.random() < 0.7 else text

    def _function(self, depth: int) -> str:
        name = self.random.choice(("math.abs", "math.sqrt", "math.round", ".length", "math.max"))
        return f"{name}({self.term(depth) if name == '.length' else self._number(depth)})"

    def _braces(self, depth: int) -> str:
        random = self.random
        kind = random.randint(0, 4)
        if kind == 0:
            return f"{{ {self._plan(min(depth, 1))} }}"
        if kind == 1:
            return f"{{ {self.literal(depth)} :- {self.formula(depth)} }}"
        if kind == 2:
            return "{ " + random.choice(("+!", "-!", "+?", "-", "+")) + self.literal(depth) + " }"
        return "{ " + (self.body(min(depth, 1)) if kind == 3 else "") + " }"

    # formulae

    def formula(self, depth: int) -> str:
        """A condition."""
        random = self.random
        if depth <= 0:
            return random.choice((self.literal(1), "true", "false", self._relation(0)))
        kind = random.randint(0, 7)
        if kind == 0:
            return f"not {self.formula(0)}"
        if kind == 1:
            return f"({self.formula(depth - 1)})"
        if kind in (2, 3):
            return f"{self._operand(depth)} {random.choice('&|')} {self._operand(depth)}"
        if kind == 4:
            return self._relation(depth)
        if kind == 5:
            return self._collecting(depth)
        return self.literal(depth)

    def _operand(self, depth: int) -> str:
        return f"({self.formula(depth - 1)})" if self.random.random() < 0.5 else self.formula(0)

    def _relation(self, depth: int) -> str:
        return f"{self._side(depth)} {self.random.choice(RELATIONS)} {self._side(depth)}"

    def _side(self, depth: int) -> str:
        return self.random.choice((self._simple, self._number, self.literal, self._list))(depth - 1)

    def _collecting(self, depth: int) -> str:
        inner = self.formula(depth - 1)
        return self.random.choice(
            (
                f".findall({self.term(1)}, ({inner}), L)",
                f".count(({inner}), N)",
                f".member({self.term(1)}, {self._list(1)})",
                f".range(I, 1, {self.random.randint(0, 9)})",
                f".type({self.term(1)}, T)",
                f".term2string({self.term(1)}, S)",
                f".concat({self.term(1)}, {self.term(1)}, C)",
            )
        )

    # bodies

    def body(self, depth: int) -> str:
        """The steps of a plan."""
        return "; ".join(self._step(depth) for _ in range(self.random.randint(1, 5)))

    def _step(self, depth: int) -> str:
        random = self.random
        kind = random.randint(0, 12 if depth > 0 else 9)
        if kind <= 1:
            return random.choice(("!", "!", "!!", "?")) + self.literal(1)
        if kind <= 3:
            return random.choice(CHANGES) + self.literal(2)
        if kind == 4:
            return f"?({self.formula(1)} & true)"
        if kind == 5:
            return random.choice((*ONE_ARGUMENT, *GOAL_CONTROL)) + f"({self.literal(1)})"
        if kind == 6:
            return random.choice(
                (".print(hello)", ".wait(5)", ".drop_all_intentions", ".send(friend, tell, p(1))")
            )
        if kind == 7:
            return self._relation(1)
        if kind == 8:
            return f"{random.choice('+-')}{self._plan_change()}"
        if kind == 9:
            return random.choice(("act(X)", "act", "X", "!X", "?X", "+X", "true", ".findall(X, p(X), L)"))
        return self._statement(depth - 1)

    def _plan_change(self) -> str:
        if self.random.random() < 0.5:
            return f"{{ {self.literal(1)} :- {self.formula(1)} }}"
        return f"{{ {self._plan(0, '!')} }}"

    def _statement(self, depth: int) -> str:
        random = self.random
        kind = random.randint(0, 3)
        if kind == 0:
            text = f"if ({self.formula(depth)}) {{ {self.body(depth)} }}"
            if random.random() < 0.3:
                text += f" elif ({self.formula(0)}) {{ {self.body(0)} }}"
            return text + (f" else {{ {self.body(0)} }}" if random.random() < 0.5 else "")
        if kind == 1:
            return f"for ({self.formula(depth)}) {{ {self.body(depth)} }}"
        if kind == 2:
            return f"while ({self.formula(depth)}) {{ {self.body(depth)} }}"
        operator = random.choice(("|&|", "|||"))
        return f"({self.body(depth)}) {operator} ({self.body(depth)})"
