"""Random programs that run: every step has an effect that output can show, and every program ends.

Goals call later goals only, waits are short, and an agent has a limited number of plans that can begin others: each takes
a belief away in one step, since many intentions do so at the same time, and fails when none is left. A number determines a
project.
"""

import json
from collections.abc import Iterator
from random import Random

GOALS, AGENTS = 7, ("ann", "bob")
PLANS = 80
"""Number of plans that an agent begins, except those that only print."""
COUNTED = "-left(L); .ground(L)"
"""The steps of a plan that count it."""
ARTIFACTS = """from jacaros.artifacts import Artifact, Out, operation


class Board(Artifact):
    def init(self, first: int = 0) -> None:
        self.puts = first
        self.define_property("count", first)
        self.define_property("note", first, "n")

    @operation
    def inc(self, by: int = 1) -> None:
        self.update_property("count", self.values("count")[0] + by)

    @operation
    def put(self, term: object) -> None:
        self.puts += 1  # no two beliefs with equal values: builds before 2026-11 merge them
        self.define_property("put", term, self.puts)

    @operation
    def take(self) -> None:
        self.remove_property("put")

    @operation
    def read(self, count: Out) -> None:
        count.set(self.values("count")[0])

    @operation
    def refuse(self, why: object) -> None:
        self.update_property("count", -1)
        self.fail("no", "refused", why)

    @operation
    async def slowly(self, milliseconds: int) -> None:
        await self.sleep(milliseconds / 1000)
        self.signal("done", milliseconds)
"""
PROJECT = """mas random {{
{agents}
    workspace w {{ artifact one: Board(1)  artifact two: Board(100) }}
}}
"""
ATOMS = (
    "a",
    "b",
    "c(1)",
    "d(X0)",
    "e(f(2),g)",
    "[1,2]",
    "[]",
    '"s"',
    "h[i]",
    "k(1)[l(2),m]",
    "-3",
    "1.5",
    "ns::o(1)",
)


class Writer:
    """Writes programs whose steps all have an effect that output can show."""

    def __init__(self, random: Random) -> None:
        self._random = random
        self._variables = self._labels = 0

    def files(self) -> dict[str, str]:
        """A project: its file, its artifacts, and a program for each agent."""
        names = AGENTS[: self._random.choice((1, 1, 2))]
        agents = "\n".join(f"    agent {name} {{ focus: w.one, w.two }}" for name in names)
        programs = {f"{name}.asl": self._program(names) for name in names}
        return {"random.jcm": PROJECT.format(agents=agents), "artifacts.py": ARTIFACTS, **programs}

    def _program(self, names: tuple[str, ...]) -> str:
        self._others = names
        lines = [f"b({self._number()}). " for _ in range(self._random.randint(0, 4))]
        lines += [
            f"c({self._term()})[{self._pick('x', 'y(1)', 'z(2), x')}]."
            for _ in range(self._random.randint(0, 3))
        ]
        lines += [
            "s([3,1,2]). " + " ".join(f"left({number})." for number in range(PLANS)),
            "ns1::o(1). ~ns1::o(2). ns1::~o(3). ns2::~o(4).",
        ]
        lines += [
            "r(X) :- b(X) & not c(X).",
            "r(X) :- c(X) & X > 1.",
            "near(X,Y) :- b(X) & b(Y) & X < Y.",
            "sum([],0). sum([H|T],S) :- sum(T,R) & S = H + R.",
        ]
        lines += [
            f"!g{self._random.randint(0, 2)}({self._number()})." for _ in range(self._random.randint(1, 2))
        ]
        lines += [
            "!end.",
            "+!end <- .wait(3000); .findall(P, b(P), L); .print(b, L); .findall(q(P,A), c(P)[A], M); .print(c, M);",
        ]
        lines += ["   .findall(I, count(I), N); .print(N); .findall(I, put(I,_), K); .print(K); .stopMAS."]
        for number in range(GOALS):
            lines += self._plans(number)
        for event in (
            "+b(X)",
            "-b(X)",
            "+count(X)",
            "+put(X,_)",
            "+done(X)",
            "+c(X)[source(S)]",
            "^!g3(X)[state(S)]",
            "+told(X)[source(S)]",
        ):
            if self._random.random() < 0.4:
                shown = "X,S" if "(S)" in event else "X"
                guard = self._pick("", " & X > 1", " & b(X)", " & not c(X)", " & r(X)")
                told = f".print({json.dumps(event)},{shown})"
                lines.append(
                    f"{event} : left(_){guard} <- {COUNTED}; {told}; {self._steps(5, 2)}."
                    if self._chance(0.7)
                    else f"{event}{guard.replace(' &', ' :')} <- {told}; {self._internal()}."
                )
        return "\n".join(lines) + "\n"

    def _plans(self, number: int) -> Iterator[str]:
        for _ in range(self._random.randint(1, 2)):
            label = f"@p{number}_{self._labels}[{self._annotation()}] " if self._chance(0.25) else ""
            self._labels += bool(label)
            self._variables = 0
            guard = f" : {self._formula(2)}" if self._chance(0.5) else ""
            condition = f" <: {self._pick('b(7)', 'count(3)', 'false')}" if self._chance(0.06) else ""
            body = f" <- {COUNTED}; .print(g{number},X0); {self._steps(number, 5)}"
            yield f"{label}+!g{number}(X0){guard}{condition}{body}{self._end_of_plan(number)}"
        if self._chance(0.7):
            handler = self._pick("", "[error(E)]", "[code(C)]", "[error_msg(_)]")
            told = {"[error(E)]": ",E", "[code(C)]": ",C"}.get(handler, "")
            self._variables = 0
            yield f"-!g{number}(X0){handler} <- {COUNTED}; .print(failed{number},X0{told}); {self._steps(number, 1)}."

    def _annotation(self) -> str:
        """What a label says of its plan."""
        found = self._fresh()
        return self._pick(
            "atomic",
            "x(1)",
            "cost(2)",
            "all_unifs",
            f"needs({self._pick('arm', 'base')})",
            f"needs(arm), urgency({self._number()})",
            f"while(b({found}) & {found} > {self._number()})",
            f"while(not c({found})), cleanup(inner(X0))",
            f"within({self._random.randint(1, 9)})",
            f"achieves({self._formula(1)}, {self._random.randint(0, 3)}), cleanup(inner(X0))",
        )

    def _end_of_plan(self, number: int) -> str:
        """A full stop, or sub-plans, some of them after a call of a goal that takes the place of the plan."""
        if not self._chance(0.15):
            return "."
        called = self._pick("", f"; !inner({self._value()})", self._tail_call(number))
        counted = COUNTED.replace("L", "K")  # the plan around it has counted in L, which the sub-plan sees
        inner = f"{counted}; .print(inner,Y,X0); {self._steps(GOALS, 1)}"
        again = self._pick("", "; !inner(Y)", "; !g6(Y)")
        return f"{called}. {{\n   +!inner(Y) <- {inner}{again}.\n   +b(Y) <- .print(seen,Y).\n}}"

    def _tail_call(self, number: int) -> str:
        return f"; !g{number + 1}({self._value()})" if number + 1 < GOALS else ""

    def _steps(self, number: int, most: int) -> str:
        return "; ".join(self._step(number, 2) for _ in range(self._random.randint(1, most)))

    def _step(self, number: int, depth: int) -> str:
        made = self._random.random()
        later = (
            f"g{self._random.randint(number + 1, GOALS - 1)}({self._value()})" if number + 1 < GOALS else ""
        )
        if later and made < 0.13:
            return self._pick("!", "!", "!", "!!") + later
        if later and made < 0.16:
            return self._pick("!", "!!") + later + self._supervision()
        if later and made < 0.24:
            return self._goal_control(later)
        if depth and made < 0.38:
            return self._control(number, depth, later)
        if made < 0.46:
            return self._environment()
        if made < 0.54 and len(self._others) > 1:
            return self._message(later)
        if made < 0.62:
            return self._plan_change(later)
        if made < 0.8:
            return self._belief()
        return self._internal()

    def _supervision(self) -> str:
        """What an annotation of a goal asks for."""
        milliseconds = self._random.randint(1, 9)
        return self._pick(
            f"[hard_deadline({milliseconds})]",
            f"[within({milliseconds})]",
            f"[retry(2, {milliseconds})]",
            f"[every({100 * milliseconds}), within(4)]",
            f"[achieves({self._formula(1)})]",
            f"[achieves({self._formula(1)}, 2), retry(2, {milliseconds}), within(9)]",
            f"[needs({self._pick('arm', 'base')})]",
        )

    def _goal_control(self, goal: str) -> str:
        wanted = goal.split("(")[0] + "(_)"
        what = self._pick(
            "drop_intention", "drop_desire", "succeed_goal", "fail_goal", "suspend", "drop_event"
        )
        end = f"; .wait(2); .resume({wanted})" if what == "suspend" else ""
        return f"!!{goal}; .wait({self._random.randint(0, 3)}); .{what}({wanted}){end}"

    def _control(self, number: int, depth: int, goal: str) -> str:
        inner = lambda: self._step(number, depth - 1)  # noqa: E731
        kind = self._random.randint(0, 7)
        if kind == 7:
            item = self._fresh()
            condition = self._pick(
                f"b({item}) & not seen{item}({item})", f"c({item})[x] & not seen{item}({item})"
            )
            few = (
                f".count(seen{item}(_),N{item}) & N{item} < 9"  # NaN is not equal to itself: it is never seen
            )
            return (
                f"while ({condition} & {few}) {{ +seen{item}({item}); {inner()} }}; .abolish(seen{item}(_))"
            )
        if kind == 0:
            return f"if ({self._formula(1)}) {{ {inner()} }} else {{ {inner()} }}"
        if kind == 1:
            item = self._fresh()
            return f"for (b({item})) {{ .print(each,{item}); {inner()} }}"
        if kind == 2:
            item = self._fresh()
            return f"for (.range({item},1,3)) {{ {inner()} }}"
        if kind == 3:
            return f"-+w{number}(0); while (w{number}(W{depth}) & W{depth} < 3) {{ -+w{number}(W{depth}+1); {inner()} }}"
        if kind == 4 and goal:
            needs = self._pick("", "", "[needs(arm)]")
            return f"({{ !{goal}{needs} }} {self._pick('|&|', '|||')} {{ {inner()} }})"
        if kind == 5:
            return f"{{ {inner()}; {inner()} }}"
        awaited = self._pick("b(_)", "count(_)", "r(_)", "{+b(_)}", "{+done(_)}")
        return f".wait({awaited}, {self._random.randint(1, 9)}, {self._fresh()})"

    def _environment(self) -> str:
        on = self._pick("", "", '[artifact_name("one")]', '[artifact_name("two")]')
        out = self._fresh()
        return self._pick(
            f"inc{on}",
            f"inc(2){on}",
            f"put({self._term()}){on}",
            f"take{on}",
            f"read({out}){on}; .print(read,{out})",
            f"refuse({self._term()}){on}",
            f"slowly({self._random.randint(0, 4)}){on}",
        )

    def _message(self, goal: str) -> str:
        other, answer = self._pick(*self._others), self._fresh()
        return self._pick(
            f".send({other}, tell, told({self._value()}))",
            f".send({other}, untell, told(_))",
            f".send({other}, askOne, b(_), {answer}, 50); .print(one,{answer})",
            f".send({other}, askAll, c(_), {answer}, 50); .print(all,{answer})",
            f".send({other}, achieve, {goal or 'none'})",
            f".send({other}, tellHow, {{ +!how(X) <- .print(how,X) }}); .send({other}, achieve, how({self._value()}))",
            f".send({other}, askHow, {{ +!g6(_) }}, {answer}, 50); .length({answer}, Z{answer}); .print(how,Z{answer})",
            f".broadcast(tell, told({self._value()}))",
        )

    def _plan_change(self, goal: str) -> str:
        found = self._fresh()
        return self._pick(
            f".add_plan({{ @m +!extra(X) <- .print(extra,X) }}, self, begin); !extra({self._value()}); .remove_plan(m)",
            f".add_plan({{ @added +!g6(X) <- .print(added,X) }}, self, end); !{goal or 'inner(1)'}; .remove_plan(added)",
            f".relevant_plans({{ +!g5(_) }}, {found}); .length({found}, N{found}); .print(plans,N{found})",
            f".findall(T, .intention(_, T), {found}); .print(states,{found})",
            f".findall(D, .desire(D), {found}); .length({found}, N{found}); .print(N{found})",
            f"if (.intend({goal or 'end'})) {{ .print(intends) }}",
            f"if (.suspended(g5(_), {found})) {{ .print({found}) }}",
            f"!inner({self._value()})",
            f'.at("now +{self._random.randint(1, 9)} ms", {{ +!extra2 }})',
        )

    def _belief(self) -> str:
        value, found, negation = self._value(), self._fresh(), self._pick("", "~")
        return self._pick(
            f"+b({value})",
            f"-b({value})",
            "-b(_)",
            f"-+b({value})",
            f"+>b({value})",
            f"+<c({value})",
            f"+c({value})[z({self._number()})]",
            f"-c(_)[{self._pick('x', 'z(2)')}]",
            f"+open({found},{self._number()}); ?open(7,O{found}); .print(O{found})",
            f"?b({found}); .print({found})",
            f"?r({found}); .print(rule,{found})",
            f"+ns1::b({value}); ?ns1::b({found}); .print({found})",
            "-ns1::b(_)",
            f"++b({value})",
            f"--b({found}); {found} = {self._number()}; .print({found})",
            f"--c({value}); .print(cs)",
            f".setof(in(N{found},{found}), N{found}::~o({found}), L{found}); .print(L{found})",
            f"N{found} = {self._pick('ns1', 'ns2')}; ?N{found}::{negation}o({found}); .print({found})",
            f"N{found} = ns2; {self._pick('+', '-', '-+')}N{found}::{negation}o({value})",
            f"?s({found}); -+s([{self._number()}|{found}])",
            f".abolish(c({value}))",
        )

    def _internal(self) -> str:
        a, b = self._fresh(), self._fresh()
        items = f"[{','.join(str(self._number()) for _ in range(self._random.randint(0, 4)))}]"
        other = self._pick(items, f"[{self._term()}|{items}]")
        return self._pick(
            f".concat({items},{other},{a}); .length({a},{b}); .print({a},{b})",
            f".reverse({other},{a}); .sort({a},{b}); .print({a},{b})",
            f"if (.nth(1,{other},{a})) {{ .print({a}) }}",
            f".findall({a}, .member({a},{other}), {b}); .print({b})",
            f".delete({self._value()},{other},{a}); .print({a})",
            f"{other} = [{a}|{b}]; .print({a},{b})",
            f".findall({a}, .sublist({a},{items}), {b}); .print({b})",
            f"?sum({items},{a}); .print({a})",
            f'.concat("ab",{self._value()},{a}); .substring({a},1,{b}); .print({a},{b})',
            f'.length("{self._pick("", "abc")}",{a}); .print({a})',
            f"{b} = {self._term()}; {b} =.. {a}; .print({a})",
            f".random({a}); .print({a})",
            f"{a} = math.round(math.random(10)) + {self._number()}; .print({a})",
            f".union({items},[1,2],{a}); .intersection({items},[1,5],{b}); .print({a},{b})",
            f".count(b(_),{a}); .print({a})",
            f".findall({a}-{b}, near({a},{b}), L{a}); .print(L{a})",
            f".setof({a}, b({a}), {b}); .print({b})",
            f".max({items},{a}); .min({items},{b}); .print({a},{b})",
            f".term2string({self._term()},{a}); .print({a})",
            ".fail",
            f".add_annot({self._term()}, an({self._number()}), {a}); .print({a})",
            f".print({self._term()} == {self._term()})",
            ".my_name(Me); .print(Me)",
            f"{a} = {self._sum()}; .print({a})",
            f".wait({self._random.randint(0, 5)})",
            f".suffix({a},{items}); .print({a})",
        )

    # parts

    def _formula(self, depth: int) -> str:
        value, found = self._value(), self._fresh()
        if depth and self._chance(0.5):
            left, right = self._formula(depth - 1), self._formula(depth - 1)
            return self._pick(f"({left} & {right})", f"({left} | {right})", f"not ({left})")
        return self._pick(
            f"b({value})",
            f"b({found}) & {found} > 1",
            f"r({found})",
            f"c({found})[x]",
            "count(1)",
            f"count({found}) & {found} < 3",
            f"s([{found}|_])",
            f".member({found},[1,2,X0])",
            f"X0 > {self._number()}",
            f"X0 == {value}",
            "true",
            f"near({found},_)",
            f"c({found}) & not b({found})",
            f".count(b(_),{found}) & {found} > 1",
            "note(_,_)[artifact_name(_,one)]",
        )

    def _term(self) -> str:
        return self._pick(
            *ATOMS, str(self._number()), f"{self._pick('p', 'q')}({self._number()},[{self._number()}])"
        )

    def _value(self) -> str:
        return self._pick("X0", str(self._number()), self._term(), self._sum())

    def _sum(self) -> str:
        operator = self._pick("+", "-", "*", " div ", " mod ", "/", "**")
        left, right = (self._pick(*(3 * [str(self._number())]), "(1/0)", "(-1/0)") for _ in range(2))
        return f"{left}{operator}{right}"

    def _number(self) -> int:
        return self._random.randint(0, 7)

    def _fresh(self) -> str:
        self._variables += 1
        return f"V{self._variables}"

    def _pick(self, *choices: str) -> str:
        return self._random.choice(choices)

    def _chance(self, share: float) -> bool:
        return self._random.random() < share
