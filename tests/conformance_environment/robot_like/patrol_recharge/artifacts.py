"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Out, link, operation

HEADINGS = {0: (1, 0), 90: (0, 1), 180: (-1, 0), 270: (0, -1)}


class Battery(Artifact):
    """Goes down with every use, and up at the charger."""

    def init(self, level: int) -> None:
        self.define_property("battery", level)
        self.define_property("diagnostics", _diagnosis(level))

    @operation
    def drain(self, amount: int) -> None:
        self._set(max(0, self.value("battery") - amount))

    @link
    def use(self, amount: int) -> None:
        self.drain(amount)

    @operation(name="operationRecharge")
    async def recharge(self) -> None:
        while self.value("battery") < 100:
            await self.sleep(0.02)
            self._set(min(100, self.value("battery") + 20))

    @operation(name="getCurrentBattery")
    def current_battery(self, level: Out) -> None:
        level.set(self.value("battery"))

    def _set(self, level: int) -> None:
        self.update_property("battery", level)
        if self.value("diagnostics") != _diagnosis(level):
            self.update_property("diagnostics", _diagnosis(level))


def _diagnosis(level: int) -> str:
    if level >= 60:
        return "Full Battery"
    return "Medium Battery" if level >= 30 else "Low Battery"


class Motion(Artifact):
    """Moves on a grid."""

    ports = ("battery",)

    def init(self, linked: str = "") -> None:
        self.define_property("pose", 0, 0, 0)
        self._linked = linked == "linked"
        self._moving = False
        self._aborted = False

    @operation(name="moveForward", guard="is_free")
    async def move_forward(self, units: int) -> None:
        self._moving, self._aborted = True, False
        try:
            if self._linked:
                await self.call_linked("battery", "use", 10 * units)
            for unit in range(units):
                await self.sleep(0.2 / units)
                if self._aborted:
                    self.fail("aborted", "aborted", unit)
                x, y, heading = self.values("pose")
                right, up = HEADINGS[heading]
                self.update_property("pose", x + right, y + up, heading)
        finally:
            self._moving = False

    @operation(guard="is_free")
    def rotate(self, degrees: int) -> None:
        x, y, heading = self.values("pose")
        self.update_property("pose", x, y, (heading + degrees) % 360)

    @operation(name="abortMoving")
    def abort_moving(self) -> None:
        self._aborted = True

    def is_free(self) -> bool:
        return not self._moving
