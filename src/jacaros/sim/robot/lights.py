"""Lights and loudspeaker of a robot, as on a Create 3 (TurtleBot 4); their commands are recorded in the ground truth."""

from jacaros.ros.message import to_seconds
from jacaros.ros.node import Sample
from jacaros.sim.robot.on_graph import RobotOnGraph


class LightsAndSound:
    """Receives the commands for the lights and the loudspeaker of one robot."""

    def __init__(self, at: RobotOnGraph) -> None:
        self._at = at
        self._colors: list[str] = []
        at.subscribe("/cmd_lightring", "irobot_create_msgs/msg/LightringLeds", self._light)
        at.subscribe("/cmd_audio", "irobot_create_msgs/msg/AudioNoteVector", self._play)

    def _light(self, sample: Sample) -> None:
        """Record colours as ``#rrggbb``, counter-clockwise from the front; none if the robot controls its lights."""
        message = sample.message
        leds = message.leds if message.override_system else ()
        colors = [f"#{led.red:02x}{led.green:02x}{led.blue:02x}" for led in leds]
        if colors != self._colors:
            self._colors = colors
            self._note("lights", {"colors": colors})

    def _play(self, sample: Sample) -> None:
        """Record notes as pairs of frequency (Hz) and duration (s)."""
        notes = [[int(note.frequency), to_seconds(note.max_runtime)] for note in sample.message.notes]
        self._note("sound", {"notes": notes, "append": bool(sample.message.append)})

    def _note(self, kind: str, data: dict[str, object]) -> None:
        self._at.time.catch_up()
        self._at.time.world.note(self._at.robot.name, kind, data)
