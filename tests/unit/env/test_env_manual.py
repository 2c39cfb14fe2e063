"""Manuals of artifact types."""

from jacaros.env import Artifact, Out, describe, internal_operation, link, operation


class Lamp(Artifact):
    """A lamp.

    It shines.
    """

    ports = ("power",)

    def init(self, watts: int, name: str = ""): ...

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
    assert manual.usage == "init(watts: an integer, name: a text (optional))"
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
    assert (first.guarded, first.pausable, first.more) == (True, True, False)
    assert [(p.name, p.expected, p.output, p.optional) for p in first.parameters] == [
        ("power", "a number", False, False),
        ("old", "an unbound variable (it is an output)", True, False),
    ]
    assert (second.usage, second.more, second.text) == ("sum(...)", True, "")


def test_a_manual_can_be_printed():
    assert str(describe(Lamp)) == (
        "Lamp: A lamp.\n\nIt shines.\n"
        "  init(watts: an integer, name: a text (optional))\n"
        "  operation setPower(power: a number, -old)\n"
        "      Set the power.\n"
        "\n"
        "      Waits until it is free.\n"
        "  operation sum(...)\n"
        "  linked operation peek(-now)\n"
        "      Tell the power.\n"
        "  internal operation flicker()\n"
        "  out ports power"
    )
    assert str(describe(Bare)) == "Bare\n  init()"


def test_the_manual_of_one_artifact_shows_its_own_operations(play):
    class Dynamic(Artifact):
        def init(self):
            self.define_operation("extra", self.extra)

        def extra(self, x: int):
            """Only here."""

    async def scene(stage):
        dynamic = await stage.make(Dynamic)
        assert describe(Dynamic).operations == ()
        (extra,) = describe(Dynamic, stage.main.interface(dynamic)).operations
        assert (extra.usage, extra.text) == ("extra(x: an integer)", "Only here.")

    play(scene)
