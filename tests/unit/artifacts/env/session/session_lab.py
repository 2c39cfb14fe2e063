"""A counter, wheels, and a session that uses them."""

from jacaros.artifacts import Artifact, Out, Session, operation


class Counter(Artifact):
    def init(self, start: int = 0):
        self.define_property("count", start)

    @operation
    def inc(self, by: int = 1):
        self.update_property("count", self.value("count") + by)
        self.signal("tick", self.value("count"))

    @operation
    def report(self, *texts: str):
        self.signal("report", self.caller, list(texts))

    @operation
    def report(self, text: str):  # noqa: F811 - replaced on purpose: exact arity
        self.signal("report", self.caller, text)

    @operation
    def never(self):
        self.fail("it never works", "never", 1)


class Wheels(Artifact):
    def init(self):
        self.define_property("pose", 0.0, 0.0)
        self.define_property("speed", 0.0)
        self.define_property("cell", 1, "free")
        self.define_property("cell", 2, "wall")

    @operation(name="moveForward", pausable=True)
    async def move_forward(self, metres: float):
        try:
            for _ in range(round(metres * 10)):
                await self.pause_point()
                self.update_property("speed", 1.0)
                await self.sleep(0.1)
                x, y = self.values("pose")
                self.update_property("pose", round(x + 0.1, 6), y)
        finally:
            self.update_property("speed", 0.0)

    @operation(name="getCurrentPose")
    def get_current_pose(self, x: Out, y: Out):
        x.set(self.value("pose", 0))
        y.set(self.value("pose", 1))

    @operation
    def x(self, out: Out):
        out.set(self.value("pose"))

    @operation
    def nothing(self, out: Out):
        pass

    @operation
    def drop(self):
        self.remove_property("cell", 1, None)

    @operation
    def flash(self):
        self.update_property("speed", 5.0)
        self.commit()
        self.update_property("speed", 0.0)


def session_in(stage, name="painter", **options):
    return Session(stage.environment, name, **options)
