"""How artifact classes declare their interface, and which errors are found when the class is created."""

from functools import partial
from typing import Any

import pytest

from jacaros.artifacts import Artifact, InvalidArtifact, Out, internal_operation, link, operation


def keys(artifact_type):
    return artifact_type.interface.operations.keys()


def test_decorators_work_with_and_without_arguments():
    class Mixed(Artifact):
        @operation
        def a(self): ...

        @operation()
        def b(self, x, y=1): ...

        @operation(name="sea")
        def c(self, x, y: Out): ...

        @link
        def d(self): ...

        @link(name="dee")
        def dd(self): ...

        @internal_operation
        def e(self): ...

        @internal_operation(name="ee")
        async def f(self): ...

        @operation
        def g(self, x, *more: object): ...

        def not_an_operation(self): ...

    assert keys(Mixed) == ["a/0", "b/1", "b/2", "sea/2", "g/any"]
    assert Mixed.interface.links.keys() == ["d/0", "dee/0"]
    assert Mixed.interface.internals.keys() == ["e/0", "ee/0"]
    declared = Mixed.interface.operations.find("b", 2)
    assert (declared.name, declared.pausable, declared.coroutine) == ("b", False, False)
    assert len(list(Mixed.interface.operations)) == 4


def test_operations_are_inherited_and_overridden_with_or_without_a_decorator():
    class Parent(Artifact):
        @operation
        def keep(self): ...

        @operation(name="go")
        def move(self, x): ...

        @operation
        def replaced(self): ...

        @operation
        def dropped(self): ...

        @operation
        def any_number(self, *x: object): ...

    class Child(Parent):
        def move(self, x, y): ...

        @operation(name="replaced")
        def other(self): ...

        dropped = None

        @operation(name="any_number")
        def another(self, *x: object): ...

    assert keys(Child) == ["keep/0", "go/2", "replaced/0", "any_number/any"]
    assert Child.interface.operations.find("replaced", 0).function is Child.other
    assert Child.interface.operations.find("any_number", 3).function is Child.another
    assert keys(Parent) == ["keep/0", "go/1", "replaced/0", "dropped/0", "any_number/any"]


def test_two_methods_with_the_same_name_and_arity_are_an_error():
    with pytest.raises(InvalidArtifact, match=r"one and .*two are both operation go with 1 arguments"):

        class Unclear(Artifact):
            @operation(name="go")
            def one(self, x): ...

            @operation(name="go")
            def two(self, x=1): ...

    with pytest.raises(InvalidArtifact, match="any number of arguments"):

        class UnclearToo(Artifact):
            @operation(name="go")
            def one(self, *x: object): ...

            @operation(name="go")
            def two(self, y, *x: object): ...


def test_names_of_the_artifact_interface_cannot_be_taken():
    with pytest.raises(InvalidArtifact, match=r'start would replace.*@operation\(name="start"\)'):

        class Taken(Artifact):
            @operation
            def start(self): ...

    with pytest.raises(InvalidArtifact, match="name would replace"):

        class TakenToo(Artifact):
            name = "mine"

    with pytest.raises(InvalidArtifact, match="interface would replace"):

        class TakenThree(Artifact):
            @operation
            def interface(self): ...


def test_init_dispose_and_ports_are_the_authors():
    class Fine(Artifact):
        ports = ("out",)

        def init(self): ...

        def dispose(self): ...

    assert Fine.ports == ("out",)


@pytest.mark.parametrize(
    ("members", "told"),
    [
        ({"guard_name": "isFree"}, "unknown guard method isFree; did you mean `is_free`?"),
        ({"guard_name": "waits"}, "expected a plain def as guard"),
        ({"guard_name": "takes_two"}, "expected a guard with the parameters of the operation"),
        ({"guard_name": "takes_two", "rest": True}, "expected a guard with the parameters of the operation"),
    ],
)
def test_guards_are_checked_when_the_class_is_made(members, told):
    def body(self, x): ...

    def any_body(self, *x: object): ...

    async def waits(self, x): ...

    def takes_two(self, x, y): ...

    function = any_body if members.get("rest") else body
    namespace: dict[str, Any] = {
        "go": operation(guard=members["guard_name"])(function),
        "is_free": lambda self: True,
        "waits": waits,
        "takes_two": takes_two,
    }
    with pytest.raises(InvalidArtifact, match=told):
        type("Guarded", (Artifact,), namespace)


def test_a_parameter_that_agents_cannot_pass_is_an_error():
    with pytest.raises(InvalidArtifact, match="keyword parameter fast"):

        class Keyword(Artifact):
            @operation
            def go(self, *, fast): ...


async def test_operations_of_one_artifact_can_be_added_and_removed(stage):
    class Dynamic(Artifact):
        def init(self):
            self.define_property("n", 0)
            self.define_operation("add", self.add, guard=lambda x: x > 0)
            self.define_operation("later", self.later, pausable=True, guard=lambda: True)

        def add(self, x: int):
            self.update_property("n", self.value("n") + x)

        async def later(self, x: int, result: Out):
            await self.sleep(1.0)
            result.set(x)

        @operation
        def forget(self):
            self.remove_operation("add")
            self.remove_operation("more")

        @operation
        def extend(self):
            self.define_operation("forget", lambda: self.fail("replaced"))
            self.define_operation("more", lambda *x: None)

        @operation
        def spoil(self):
            self.define_operation("wrong", self.add, guard=lambda x, y: True)

    first, second = await stage.make(Dynamic, name="a"), await stage.make(Dynamic, name="b")
    assert stage.main.providers("add", 1) == (first, second)
    assert stage.call(first, "add", 3).ok
    assert stage.property(first, "n") == (3,)
    assert stage.call(first, "add", -3).outcome is None, "its guard is false"
    result = Out()
    call = stage.call(first, "later", 7, result)
    assert call.execution.pausable
    await call.wait()
    assert result.value == 7
    stage.call(first, "forget")
    assert stage.main.providers("add", 1) == (second,)
    assert stage.call(first, "add", 3).reason.functor == "unknown_operation"
    assert stage.call(second, "add", 3).ok
    stage.call(first, "extend")
    assert stage.call(first, "forget").outcome.message == "replaced"
    assert stage.call(second, "forget").ok
    assert stage.call(first, "more", 1, 2, 3).ok
    assert (
        "expected a guard with the parameters of the operation" in stage.call(first, "spoil").outcome.message
    )
    assert Dynamic.interface.operations.find("add", 1) is None


async def test_partial_functions_and_callable_objects_can_be_operations(stage):
    class Greeting:
        """Greets."""

        def __call__(self, whom: str):
            raise ValueError(whom)

    class Dynamic(Artifact):
        def init(self):
            self.define_operation("soup", partial(self.order, "soup"))
            self.define_operation("greet", Greeting())
            with pytest.raises(InvalidArtifact, match="are both operation soup with 1 arguments"):
                self.define_operation("soup", partial(self.order, "fish"))

        def order(self, dish: str, price: Out):
            """Order a dish."""
            price.set(len(dish))

    it = await stage.make(Dynamic)
    price = Out()
    assert stage.call(it, "soup", price).ok
    assert price.value == 4
    assert "expected a text" in stage.call(it, "greet", 3).outcome.message
    assert "ValueError in operation greet/1 of it: bob" in stage.call(it, "greet", "bob").outcome.message
    assert set(stage.main.offers(it)) == {"soup/1", "greet/1"}
