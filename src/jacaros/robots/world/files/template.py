"""Templates of world files, with comments for their author."""

from pathlib import Path

from jacaros.robots.world.data.world import WorldError
from jacaros.robots.world.files.map import free_place, read_map
from jacaros.runtime.files.texts import shown_from

_NEW = """\
# A world of two rooms. Lengths are metres, angles degrees counter-clockwise from the x axis.
name: {name}
size: [6, 4]                                  # centred at (0, 0); or bounds: {{from: [x, y], to: [x, y]}}
border: walls                                 # around the whole world; or open
walls:
  - segment: [[0, -2], [0, -0.6]]             # a doorway of 1.2 m between the rooms
  - segment: [[0, 0.6], [0, 2]]
  - box: {{from: [2.2, 1.2], to: [3, 2], kind: sofa, color: blue}}
rooms:
  kitchen: {{from: [-3, -2], to: [0, 2]}}       # with dirt: {{from: [-3, -2], to: [0, 2], dirt: {{dust: 40}}}}
  living_room: {{from: [0, -2], to: [3, 2]}}
# doors:                                      # agents open and close them with the service /doors/hall/open
#   - {{name: hall, segment: [[0, -0.6], [0, 0.6]], open: true}}
docks:
  - {{name: dock, x: -2.5, y: 0, yaw_degrees: 0}}
robots:
  - name: turtlebot
    pose: {{x: -2, y: 0, yaw_degrees: 0}}
    odometry: {{noise_per_metre: 0.02, noise_degrees_per_turn: 2}}   # wheel slip; remove for exact odometry
    # namespace: robot_1                      # prefix of its topics; must differ between robots
    # battery: {{level: 100, drain_per_second: 0.01, drain_per_metre: 0.02}}
    # tools: {{vacuum: {{removes: [dust]}}}}        # cleaning tools, used with the topic /cleaning/tool
# people:                                     # walk from point to point, and stop in front of robots
#   - {{name: ann, path: [[1, -1], [1, 1]], pause: 2, loop: true}}
"""

_OF_MAP = """\
# A world on a map of ROS's map_server, {width:g} x {height:g} m. Lengths are metres, angles degrees.
name: {name}
map: {map}
# rooms:                                      # names for places: opposite corners
#   lobby: {{from: [{x}, {y}], to: [{x_room}, {y_room}]}}
docks:
  - {{name: dock, x: {x}, y: {y}, yaw_degrees: 0}}
robots:
  - name: turtlebot
    pose: {{x: {x}, y: {y}, yaw_degrees: 0}}
    odometry: {{noise_per_metre: 0.02, noise_degrees_per_turn: 2}}   # wheel slip; remove for exact odometry
"""


def new_world(name: str) -> str:
    """Return the text of a world file with two rooms."""
    return _NEW.format(name=_quoted(name))


def world_of_map(path: Path, map_file: Path) -> str:
    """Return the text of a world file for *path*, with the walls of a map and a robot at a free place.

    Raises:
        WorldError: the map has mistakes, or no free place.
    """
    text, problems, found = read_map(map_file)
    place = free_place(found, problems)
    if found is None or place is None:
        raise WorldError(str(map_file), text, problems)
    left, bottom, right, top = found.bounds
    x, y = (round(value, 3) for value in place)
    return _OF_MAP.format(
        width=round(right - left, 3),
        height=round(top - bottom, 3),
        name=_quoted(path.stem),
        map=_quoted(shown_from(path.parent, map_file)),
        x=x,
        y=y,
        x_room=round(x + 1.0, 3),
        y_room=round(y + 1.0, 3),
    )


def described_map(image: Path, path: Path, resolution: float) -> str:
    """Return the text of a map file for *path* and an image; the origin is the lower left corner of the image."""
    return (
        f"image: {_quoted(shown_from(path.parent, image))}\nresolution: {resolution:g}\norigin: [0, 0, 0]\n"
    )


def _quoted(text: str) -> str:
    r"""Return a YAML string, with quotes and backslashes as ``\"`` and ``\\``."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'
