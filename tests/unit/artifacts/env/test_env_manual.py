"""Manuals of artifact types."""

from jacaros.artifacts import Artifact, Out, describe, initializer, internal_operation, link, operation


class Shining(Artifact):
    """Shines.

    Properties:
        power(Watts): what all that shines takes
        colour(R, G, B), mode(M): both between 0 and 1, as in the
            docstring of its base.
    """


class Lamp(Shining):
    """A lamp.

    It shines.

    Properties:
        power(Watts): what it takes, in watts

    Signals:
        burnt(Hours): after so many hours.

    Attributes:
        shade: for authors.
    """

    ports = ("power",)
    shade = None

    def init(self, watts: int, name: str = ""):
        self.define_property("power", watts)
        self.define_property("name", name)
        self.define_property("state", int(watts), "on", True, [1, 2], -watts, self._watts)
        self.define_property("row", *range(3))
        self.define_property(name + "x", 1)
        if not name:
            self.signal("tick")
        self.signal_to("bob", "told", "him", 3)

    @initializer
    def init_in_a_room(self, watts: int, name: str, room: str):
        """In a room.

        Raises:
            OperationFailed: never.
        """

    @operation(name="setPower", guard="is_free", pausable=True)
    async def set_power(self, power: float, old: Out):
        """Set the power.

        Waits until it is free.
        """

    def is_free(self):
        return True

    @operation
    def sum(self, *more: object): ...

    @link
    def peek(self, now: Out):
        """Tell the power."""

    @internal_operation
    def flicker(self): ...


class Bare(Artifact):
    pass


def test_a_manual_tells_what_a_type_offers():
    manual = describe(Lamp)
    assert (manual.type_name, manual.text) == ("Lamp", "A lamp.\n\nIt shines.")
    assert len(manual.inits) == 2
    assert manual.ports == ("power",)
    assert [(each.kind, each.name) for each in manual.operations] == [
        ("operation", "setPower"),
        ("operation", "sum"),
        ("linked operation", "peek"),
        ("internal operation", "flicker"),
    ]
    first, second = manual.operations[:2]
    assert first.usage == "setPower(power: a number, -old)"
    assert first.text == "Set the power.\n\nWaits until it is free."
    assert (first.guarded, first.pausable) == (True, True)
    assert (second.usage, second.text) == ("sum(...)", "")
    assert [each.name for each in manual.properties] == ["power", "colour", "mode", "name", "state", "row"]
    assert [each.name for each in manual.signals] == ["burnt", "tick", "told"]


def test_a_type_created_at_run_time_is_described_without_its_source():
    names = {"Artifact": Artifact}
    exec("class Made(Artifact):\n    def init(self):\n        self.define_property('p', 1)\n", names)
    assert describe(names["Made"]).properties == ()


def test_a_manual_can_be_printed():
    assert str(describe(Lamp)) == (
        "Lamp\n"
        "  A lamp.\n"
        "\n"
        "  It shines.\n"
        "made with:\n"
        "  init(watts: an integer, name: a text (optional))\n"
        "  init(watts: an integer, name: a text, room: a text)\n"
        "      In a room.\n"
        "properties:\n"
        "  power(Watts)\n"
        "      what it takes, in watts\n"
        "  colour(R, G, B)\n"
        "      both between 0 and 1, as in the docstring of its base.\n"
        "  mode(M)\n"
        "      both between 0 and 1, as in the docstring of its base.\n"
        "  name(name)\n"
        "  state(watts, _, _, _, _, watts)\n"
        "  row(...)\n"
        "signals:\n"
        "  burnt(Hours)\n"
        "      after so many hours.\n"
        "  tick\n"
        "  told(_, _)\n"
        "operations:\n"
        "  setPower(power: a number, -old)  [may wait, pausable]\n"
        "      Set the power.\n"
        "\n"
        "      Waits until it is free.\n"
        "  sum(...)\n"
        "linked operations:\n"
        "  peek(-now)\n"
        "      Tell the power.\n"
        "out ports: power"
    )
    assert str(describe(Bare)) == "Bare\nmade with:\n  init()"


class Meter(Artifact):
    """Counts."""

    def init(self):
        self.define_property("count", 0)

    @operation
    def inc(self):
        self.signal("counted", self.value("count"), self.value("count", 0))


def test_a_value_read_from_a_property_is_called_like_it():
    assert [each.usage for each in describe(Meter).signals] == ["counted(count, count)"]
