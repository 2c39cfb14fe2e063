"""Python agents send and receive beliefs and questions."""

from python_agents_lab import BOTH, Ran


def test_it_tells_and_achieves(talk: Ran) -> None:
    result = talk("""
async def run(self):
    self.send("bob", "tell", "painted(wall)")
    self.send("bob", "tell", Literal("painted", (Atom("door"), "red", [1, 2])))
    self.send("bob", "achieve", "paint(X)")
    self.send(["bob"], "tellHow", "+!clean <- .print(cleaned).")
    self.broadcast("achieve", Atom("clean"))
    self.send("bob", "untell", "painted(wall)")
# bob
+painted(X)[source(S)] <- .print(X, " ", S).  -painted(X) <- .print("not ", X).
           +painted(A, B, C) <- .print(A, B, C).  +!paint(_) <- .print(paint).
""")
    assert sorted(result.of("bob")) == ["cleaned", "doorred[1,2]", "not wall", "paint", "wall a"]
    assert result.errors == []


def test_it_asks(talk: Ran) -> None:
    result = talk("""
async def run(self):
    one = await self.ask("bob", "colour(X)")
    self.print(one.functor, " ", one.arguments)
    self.print(await self.ask("bob", "colour(X)", "askAll"), await self.ask("bob", "size(X)", "askAll"))
    self.print(await self.ask("bob", "size(X)"))
    self.print(len(await self.ask("bob", "+!go", "askHow")))
    try:
        await self.ask("bob", "slow(X)", timeout=0.5)
    except TimeoutError as error:
        self.print(error, " ", self.clock.now() % 1)
    await self.sleep(1)
    self.print((await self.ask("bob", "slow(X)")).arguments[0])
# bob
colour(red). colour(blue). !go. +!go. +?slow(1) <- .wait(700).
""")
    assert result.of("a") == [
        "colour [red]",
        "[colour(red),colour(blue)][]",
        "None",
        "1",
        "no answer from bob within 0.5 s 0.5",
        "1",
    ]
    assert result.errors == []


def test_it_receives_beliefs_and_questions(talk: Ran) -> None:
    result = talk("""
async def run(self):
    async for message in self.messages():
        self.print(message.performative, " ", message.content, " ", message.sender)
        if message.performative == "askAll":
            message.reply(["size(1)", Literal("size", (2,))])
        elif message.is_question:
            message.reply(None if message.content.functor == "weight" else "size(3)")
# bob
!go. +!go <- .send(a, tell, [p(1), "x"]); .send(a, askOne, size(X), A); .print(A);
             .send(a, askOne, weight(X), B); .print(B); .send(a, askAll, size(X), C); .print(C);
             .send(a, achieve, g(f(2)[s])); .send(a, askOne, size(Z)).
           +size(N)[source(S)] <- .print(N, S).
""")
    assert result.of("bob") == [
        "size(3)[source(a)]",
        "false",
        "[size(1)[source(a)],size(2)[source(a)]]",
        "3a",
    ]
    assert result.of("a")[0] == 'tell [p(1),"x"] bob'
    assert result.of("a")[4] == "achieve g(f(2)[s]) bob"
    assert result.errors == []


def test_handlers_are_called_in_turn(run: Ran) -> None:
    result = run(
        m_jcm=BOTH.format("counter", "Counter"),
        a_py="""
class A(PythonAgent):
    async def on_message(self, message):
        await self.sleep(0.5)
        self.print(message)
        if message.is_question:
            return Literal("size", (3,))

    def on_signal(self, signal):
        self.print(signal.name, signal.arguments)

    def on_property(self, change):
        self.print(change.name, " ", change.before, " ", change.now)
""",
        bob_asl="""!go. +!go <- inc; .send(a, tell, hello); .send(a, askOne, size(X), A); inc; .print(A);
            .send(a, achieve, clean).""",
    )
    assert result.of("a") == [
        "count None [0]",
        "tick[1]",
        "count [0] [1]",
        "tell from bob: hello",
        "askOne from bob: size(X)",
        "tick[2]",
        "count [1] [2]",
        "achieve from bob: clean",
    ]
    assert result.of("bob") == ["size(3)[source(a)]"]
    assert result.errors == []


def test_an_agent_that_has_ended_gives_no_answers(talk: Ran) -> None:
    result = talk("""
async def run(self):
    await self.sleep(1)
    self.print("over")
# bob
!go. +!go <- .send(a, tell, p); .send(a, askOne, size(X), A); .print(A);
     .send(a, askOne, size(X), B); .print(B); .all_names(L); .print(L).
""")
    assert result.lines == ["[a] over", "[bob] false", "[bob] false", "[bob] [a,bob]"]


def test_a_message_to_an_unknown_agent_is_an_error_in_python(alone: Ran) -> None:
    body = """
async def run(self):
    for receiver in ("other", "a"):
        try:
            self.send(receiver, "tell", "p")
        except UnknownAgent as error:
            self.print(error)
    self.print((await self.receive()).sender)
    try:
        await self.receive(timeout=1.5)
    except TimeoutError as error:
        self.print(error)
    try:
        self.send("a", "tell", "p(")
    except Exception as error:
        self.print(type(error).__name__)
"""
    assert alone(body).of("a") == [
        "unknown agent `other`; agents: a",
        "self",
        "no message within 1.5 s",
        "AslError",
    ]


def test_the_directory_facilitator_knows_it(talk: Ran) -> None:
    result = talk("""
async def run(self):
    self.register_service("paint")
    self.subscribe_to_service("sell")
    self.print(await self.receive())
    self.print(self.providers("sell"), self.providers("paint"))
    self.deregister_service("paint")
    self.print(self.providers("paint"))
# bob
!go. +!go <- .df_search(paint, L); .print(L); .df_register(sell).
""")
    assert result.of("bob") == ["[a]"]
    assert result.of("a") == ['tell from df: provider(bob,"sell")', '["bob"]["a"]', "[]"]


def test_all_kinds_of_contents_are_received(talk: Ran) -> None:
    result = talk("""
async def run(self):
    async for message in self.messages():
        self.print(message.performative, " ", repr(message.content))
        if message.performative == "askHow":
            message.reply(["+!g(X) <- .print(X)."])
# bob
!go. +!go <- .send(a, tellHow, {+!g(X) : p(X) <- .print(x)}); .send(a, untellHow, "l1");
            .send(a, askHow, {+!g(_)}, P); .print(P); .send(a, signal, s(1)); .send(a, unachieve, g(2));
            .send(a, tell, [1, "text", b]); .send(a, tell, "text"); .send(a, tell, 7); .send(a, unknown, ~n::f(3)).
""")
    assert result.of("bob") == ['["+!g(X) <- .print(X)."]']
    assert result.of("a") == [
        "tellHow '{ +!g(X) : p(X) <- .print(x) }'",
        "untellHow 'l1'",
        "askHow '{ +!g(_1) }'",
        "signal Literal(functor='s', arguments=(1,), annotations=(), negated=False, namespace=None)",
        "unachieve Literal(functor='g', arguments=(2,), annotations=(), negated=False, namespace=None)",
        "tell [1, 'text', Literal(functor='b', arguments=(), annotations=(), negated=False, namespace=None)]",
        "tell 'text'",
        "tell 7",
        "unknown Literal(functor='f', arguments=(3,), annotations=(), negated=True, namespace='n')",
    ]
