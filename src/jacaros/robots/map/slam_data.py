"""``ArtSlamData`` of the thesis: the ground as labelled cells, the cells in an agent's range of view, and routes."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import ClassVar

from jacaros.artifacts.env.artifact import Out, operation
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.robots.kit.options import not_negative, positive, text
from jacaros.robots.kit.ros_artifact import RosArtifact
from jacaros.robots.map.cells import FREE, GOAL, OBSTACLE, UNKNOWN, Cell, LabelledCells, picture
from jacaros.robots.map.routes import DEGREES, compass, inflated, route
from jacaros.robots.plane.pose import normalised

ME = Atom("me")
"""The agent, as the first argument of ``pos2d(Object, X, Y)``."""


class ArtSlamData(RosArtifact):
    """A map of cells with integer coordinates and one label each, such as free, obstacle, goal, home.

    It needs no ROS: agents write what they find out, and read what is near (range of view), so that no belief base
    has to hold the whole map. x points east, y north (thesis, chapter 9 and listing B.1).

    Options:
        obstacle(Label): another label for cells that no route enters.
        cell_size(S): side of a cell in metres (1).
        radius(R): clearance of the robot, in metres (0): routes keep the centres of cells farther than this from
            those of obstacles.

    Properties:
        pos2d(X, Y): the agent's cell, initially 0, 0.
        pos2d(Object, X, Y): the cell of an object. Object: atom. It is `me`, the agent; each place, which is a
            cell with a label other than free, obstacle and unknown, such as `home` and `goal`; each thing of
            `updateObject`; and `obstacle`, one for each obstacle in the newest range of view.
        cell(X, Y, Label): one for each labelled cell of the newest range of view.
        currentRange(List): the same as a list of ``cell(X, Y, Label)``.
        route(List): the newest route, a list of ``cell(X, Y)`` from the agent's cell to the goal.
        direction(D): the direction of the next step of the route, an atom: `east`, `northeast`, `north` ..., or
            `reached` at its end.
        degrees(D): how far to turn for that, in (-180, 180], positive to the left. An agent that has not moved faces
            east, or as the first argument says: ``makeArtifact("m", "ArtSlamData", ["north"], Id)``.

    Signals:
        currentRange(X, Y, Label): after `getVisionRange`, one for each labelled cell, column by column.
    """

    known_options: ClassVar = {"obstacle": text, "cell_size": positive, "radius": not_negative}
    usual_size: ClassVar[float] = 1.0
    usual_radius: ClassVar[float] = 0.0

    def open(self) -> None:
        """Begin with an empty map."""
        self.size = self.option("cell_size", self.usual_size)
        self.radius = self.option("radius", self.usual_radius)
        self.cells = self.new_cells(self.option("obstacle", OBSTACLE))
        self.here: Cell = (0, 0)
        self.heading = DEGREES.get(self.robot, 0.0)
        self.way: list[Cell] = []
        self._driven = 0.0
        self._asked_at = 0.0
        self._things: dict[str, Cell] = {}
        self._obstacles: list[Cell] = []
        self.define_property("pos2d", *self.here)
        self.define_property("pos2d", ME, *self.here)
        self.define_property("currentRange", [])
        self.define_property("route", [])
        self.define_property("direction", Atom("reached"))
        self.define_property("degrees", 0)

    def new_cells(self, obstacle: str) -> LabelledCells:
        """Return the initial cells. Subclasses with sensors override it."""
        return LabelledCells(obstacle)

    # ---- labels

    @operation(name="updateSlamData")
    def update_slam_data(self, x: int, y: int, label: str) -> None:
        """Label a cell; an earlier label is replaced."""
        if self.cells.put((x, y), str(label)):
            self.show_objects()

    @operation(name="updateObject")
    def update_object(self, thing: str, x: int, y: int) -> None:
        """Set the cell of a movable thing, such as another robot; its previous cell is forgotten."""
        self._things[str(thing)] = (x, y)
        self.show_objects()

    @operation(name="removeObject")
    def remove_object(self, thing: str) -> None:
        """Forget a thing; no effect if it is unknown."""
        self._things.pop(str(thing), None)
        self.show_objects()

    @operation(name="getSlamData")
    def get_slam_data(self, x: int, y: int, label: Out) -> None:
        """Give the label of a cell, the atom ``unknown`` if it has none."""
        label.set(self.cells.label((x, y)) or Atom(UNKNOWN))

    @operation
    @operation(name="clearSlamData")
    def clear(self) -> None:
        """Forget all labels and things, and the range of view and route based on them."""
        self.cells.clear()
        self._things.clear()
        self.way = []
        self.begin_with_map()
        self._show_range([])
        self.update_property("route", [])

    @operation(name="printSlamData")
    def print_slam_data(self) -> None:
        """Print the map, north at the top.

        ``.`` is free, ``#`` an obstacle, ``@`` the agent, a capital letter the initial of a place or thing.
        """
        things = {cell: name for name, cell in self._things.items()}
        for line in picture(self.cells, things, self.here):
            self.log(line)

    # ---- the agent's position

    @operation(name="updatePos")
    def update_pos(self, x: int, y: int) -> None:
        """Set the agent's cell."""
        self.stand((x, y), self.heading)

    @operation(name="updatePos")
    def update_pos_and_direction(self, direction: str, x: int, y: int) -> None:
        """Set the direction that the agent faces, such as ``east``, and its cell. Fails with ``unknown_direction(D)``
        for another word."""
        degrees = DEGREES.get(str(direction))
        if degrees is None:
            known = ", ".join(DEGREES)
            told = f"unknown direction `{direction}`: expected one of {known}"
            self.fail(told, "unknown_direction", direction)
        self.stand((x, y), degrees)

    @operation(name="moveUp")
    def move_up(self) -> None:
        """Move the agent to the next cell in the north (y + 1), facing north."""
        self._step(0, 1)

    @operation(name="moveDown")
    def move_down(self) -> None:
        """Move the agent to the next cell in the south (y - 1), facing south."""
        self._step(0, -1)

    @operation(name="moveLeft")
    def move_left(self) -> None:
        """Move the agent to the next cell in the west (x - 1), facing west."""
        self._step(-1, 0)

    @operation(name="moveRight")
    def move_right(self) -> None:
        """Move the agent to the next cell in the east (x + 1), facing east."""
        self._step(1, 0)

    def _step(self, dx: int, dy: int) -> None:
        x, y = self.here
        there = (x + dx, y + dy)
        self.stand(there, DEGREES[compass(self.here, there)])

    def stand(self, cell: Cell, heading: float, distance: float | None = None) -> None:
        """Set the agent's position.

        Args:
            cell: the agent's cell.
            heading: direction that it faces, in degrees.
            distance: metres driven since the last call; None: the straight line.
        """
        self._driven += self.size * math.dist(self.here, cell) if distance is None else distance
        self.heading = heading
        if cell != self.here:
            self.here = cell
            self.update_property("pos2d", *cell, where=(None, None))
            self.update_property("pos2d", ME, *cell, where=(ME, None, None))

    @operation(name="getDistance")
    def get_distance(self, metres: Out) -> None:
        """Give the distance that the agent has moved since the last call, in metres."""
        metres.set(self.driven - self._asked_at)
        self._asked_at = self.driven

    @property
    def driven(self) -> float:
        """Metres moved so far."""
        return self._driven

    # ---- the range of view

    @operation(name="getVisionRange")
    def get_vision_range(self, x: int, y: int, reach: int) -> None:
        """Show all labelled cells up to *reach* cells from *x*, *y*, in place of the previous range."""
        near = self.cells.near((x, y), max(0, reach))
        self._show_range(near)
        for cell in near:
            self.signal("currentRange", *cell, self.cells.label(cell))

    def _show_range(self, cells: Sequence[Cell]) -> None:
        """Replace the cells shown; an unchanged cell causes no event."""
        shown = [(*cell, self.cells.label(cell)) for cell in cells]
        self.show_elements("cell", shown)
        self.update_property("currentRange", [Structure("cell", each) for each in shown])
        self.show_obstacles(cells)

    def show_obstacles(self, cells: Sequence[Cell]) -> None:
        """Show the obstacles among some cells as ``pos2d(obstacle, X, Y)``, and no others."""
        self._obstacles = [cell for cell in cells if self.cells.label(cell) == self.cells.obstacle]
        self.show_objects()

    def show_objects(self) -> None:
        """Show the positions of objects as ``pos2d(Object, X, Y)``."""
        objects: list[tuple[object, ...]] = [(ME, *self.here)]
        objects += [(Atom(label), *cell) for cell, label in self.cells.places().items()]
        objects += [(Atom(name), *cell) for name, cell in self._things.items()]
        objects += [(Atom(OBSTACLE), *cell) for cell in self._obstacles]
        self.show_elements("pos2d", objects, 3)

    # ---- routes

    @operation(name="getRoute")
    def get_route(self) -> None:
        """Show the shortest route from the agent's cell to the nearest cell labelled ``goal``.

        Fails with ``no_goal``, or with ``no_route(X, Y)`` if the goal cannot be reached over known cells.
        """
        self.find_route(self._goal())

    @operation(name="getRoute")
    def give_route(self, found: Out) -> None:
        """As `get_route`, and give the route to the caller."""
        found.set(self.find_route(self._goal()))

    @operation(name="getRoute")
    def get_route_to(self, x: int, y: int) -> None:
        """Show the shortest route from the agent's cell to the cell *x*, *y*."""
        self.find_route((x, y))

    @operation(name="getRoute")
    def give_route_to(self, x: int, y: int, found: Out | str) -> None:
        """As `get_route_to`, and give the route to the caller.

        With ``"X"`` or ``"Y"`` as the third argument, the first two are the present and the target coordinate on that
        axis: `route` shows the text ``"east"``, ``"west"``, ``"north"``, ``"south"`` or ``"reached"``, `degrees` the
        necessary turn, and the agent then faces that way. Signals ``tick_route``; fails with ``unknown_axis(Axis)``.
        """
        if isinstance(found, Out):
            found.set(self.find_route((x, y)))
        else:
            self._route_along(x, y, found)

    def _route_along(self, current: int, goal: int, axis: str) -> None:
        words = {"X": ("west", "east"), "Y": ("south", "north")}.get(axis.upper())
        if words is None:
            self.fail(f"unknown axis `{axis}`: expected X or Y", "unknown_axis", axis)
        word = "reached" if current == goal else words[goal > current]
        self.update_properties(word, self._turn_to(DEGREES.get(word, self.heading)))
        self.signal("tick_route")

    @operation(name="updateProperties")
    def update_properties(self, route: str, degrees: float) -> None:
        """Show other values of `route` and `degrees`; an agent with the route ``"east"`` faces east."""
        self.heading = DEGREES.get(str(route), self.heading)
        self.update_property("route", str(route))
        self.update_property("degrees", degrees)

    def _turn_to(self, heading: float) -> float:
        """Return the turn in degrees from the agent's heading to *heading*, in (-180, 180]."""
        return normalised(heading - self.heading, 360.0)

    def _goal(self) -> Cell:
        x, y = self.here
        goals = [cell for cell, label in self.cells.places().items() if label == GOAL]
        if not goals:
            self.fail("no cell is labelled goal", "no_goal")
        return min(goals, key=lambda cell: (math.hypot(cell[0] - x, cell[1] - y), cell))

    def find_route(self, goal: Cell) -> list[Structure]:
        """Show the route to *goal*, and return it."""
        free = self.enterable()
        if goal not in free:
            near = f", or within {self.radius:g} m of an obstacle" if self.radius else ""
            self.fail(f"cell {goal[0]}, {goal[1]} is not known to be free{near}", "no_route", *goal)
        way = route(free, self.here, goal)
        if way is None:
            self.fail(f"no route to cell {goal[0]}, {goal[1]}", "no_route", *goal)
        self.way = way
        cells = [Structure("cell", cell) for cell in way]
        self.update_property("route", cells)
        self._show_direction(way)
        return cells

    def enterable(self) -> set[Cell]:
        """Return the cells that a route may enter: passable, and not too close to an obstacle."""
        if not self.radius:
            return self.cells.passable()
        return inflated(self.cells.passable(), self.cells.blocked(), self.radius / self.size, self.here)

    def _show_direction(self, way: list[Cell]) -> None:
        if len(way) < 2:
            self.update_property("direction", Atom("reached"))
            return
        word = compass(way[0], way[1])
        self.update_property("direction", Atom(word))
        self.update_property("degrees", self._turn_to(DEGREES[word]))

    # ---- files

    @operation(name="saveMap")
    def save_map(self, file: str) -> None:
        """Write the map in the format of map_server: *file*, such as ``runs/flat.yaml``, and an image next to it.

        Places are included. Fails with ``map_file(File)`` if the file cannot be written, and with ``restricted`` in a
        run with ``--restrict``.
        """
        self._check_files("saveMap")
        from jacaros.robots.map.map_files import save

        ground = dict.fromkeys(self.cells.passable(), FREE) | dict.fromkeys(self.cells.blocked(), OBSTACLE)
        places = {name: cell for cell, name in self.cells.places().items()}
        try:
            save(Path(file), self.size, ground, places)
        except OSError as error:
            self.fail(f"cannot write the map `{file}`: {error}", "map_file", file)

    @operation(name="loadMap")
    def load_map(self, file: str) -> None:
        """Replace the map by one in the format of map_server; its places are added.

        Fails with ``map_file(File)`` if the file cannot be read or its cells are larger than ``cell_size(S)``, and
        with ``restricted`` in a run with ``--restrict``.
        """
        self._check_files("loadMap")
        from jacaros.robots.map.map_files import MapFileError, load

        try:
            saved = load(Path(file))
        except MapFileError as error:
            self.fail(str(error), "map_file", file)
        if saved.grid.resolution > self.size * 1.001:
            text = f"the cells of `{file}` are {saved.grid.resolution:g} m wide, more than cell_size({self.size:g})"
            self.fail(text, "map_file", file)
        self.cells.load(saved.grid.labels(self.size))
        for name, (x, y) in saved.places.items():
            self.cells.put((round(x / self.size), round(y / self.size)), name)
        self.begin_with_map()
        self.show_objects()

    def begin_with_map(self) -> None:
        """Called after a map was loaded or cleared. Subclasses with sensors override it."""

    def _check_files(self, name: str) -> None:
        if self.resources.get("restricted"):
            self.fail(f"{name} is forbidden: this run is restricted (--restrict)", "restricted")
