"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Atom, Out, Structure, operation


class Echo(Artifact):
    """Gives values back."""

    def init(self) -> None:
        self._thing = object()

    @operation
    def echo(self, value: object, same: Out) -> None:
        same.set(value)

    @operation
    def kind(self, value: object, kind: Out) -> None:
        kinds = {bool: "boolean", int: "number", float: "number", str: "text", list: "list"}
        kinds |= {Atom: "atom", Structure: "structure", dict: "map"}
        kind.set(kinds.get(type(value), "other"))

    @operation
    def words(self, word: Out, true: Out, false: Out, items: Out, nothing: Out) -> None:
        word.set("word")
        true.set(True)
        false.set(False)
        items.set(["a", 1])

    @operation
    def map(self, result: Out) -> None:
        result.set({"a": 1})

    @operation
    def thing(self, result: Out) -> None:
        result.set(self._thing)

    @operation(name="is")
    def is_it(self, thing: object, yes: Out) -> None:
        yes.set(thing is self._thing)

    @operation
    def fill(self, places: list) -> None:
        places[0].set(1)
        places[1].arguments[0].set("two")
