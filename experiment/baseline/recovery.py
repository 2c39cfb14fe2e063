"""The recovery tree of Nav2's `bt_navigator` around each goal of a task, in py_trees.

It is the default tree of Nav2 in ROS 2 Jazzy, `navigate_to_pose_w_replanning_and_recovery.xml`. No package index has
BehaviorTree.CPP, which runs it there, so its nodes are written here, by their documentation:

    RecoveryNode NavigateRecovery, 6 retries
      RecoveryNode NavigateToPose, 1 retry
        NavigateToPose
        Fallback, the costmap of what failed
          Sequence: WouldAPlannerRecoveryHelp, ClearEntireCostmap (global)
          Sequence: WouldAControllerRecoveryHelp, ClearEntireCostmap (local)
      Sequence
        Fallback: WouldAControllerRecoveryHelp, WouldAPlannerRecoveryHelp
        RoundRobin RecoveryActions
          Sequence: ClearEntireCostmap (local), ClearEntireCostmap (global)
          Spin by 1.57 rad
          Wait for 5 s
          BackUp by 0.30 m at 0.15 m/s

The same as in Nav2: the recoveries with their order and numbers, the error codes that recoveries help against, how each
node treats its children, and that a new goal begins with the first recovery.

Not the same:
- NavigateToPose takes the place of ComputePathToPose and FollowPath, because the simulated Nav2 plans, replans and drives
  in one action. PipelineSequence and RateController, which join the two, are missing.
- That action replans when the way is blocked, not once a second. Before it aborts, it steps back and replans three times
  in a row.
- GoalUpdated is missing: the tasks cancel a goal and send another, they do not update one.
- BackUp is DriveOnHeading with a negative distance, as inside Nav2. Wait is a timer of the tree.
- A goal that is aborted without an error code, or because it takes too long, counts as UNKNOWN: the code that Nav2's
  servers give to failures for which they have no other.
- After a goal the task sends another one, after the pause of the baseline, until a place has been tried as often as by the
  baseline: 20 attempts are 3 goals with up to 7 each.
- The tree is ticked 10 times a second, not 100 times.
"""

import math

import py_trees
from action_msgs.msg import GoalStatus
from nav2_msgs.action import DriveOnHeading, Spin
from nav2_msgs.srv import ClearEntireCostmap
from py_trees.common import Status
from rclpy.action import ActionClient

RETRIES = 6  # of a goal, each after a recovery
TIME_ALLOWANCE = 10  # seconds for a motion
CONTROLLER = (100, 104, 105, 106)  # UNKNOWN, PATIENCE_EXCEEDED, FAILED_TO_MAKE_PROGRESS, NO_VALID_CONTROL
PLANNER = (200, 207, 208)  # UNKNOWN, TIMEOUT, NO_VALID_PATH
UNKNOWN = (0, 9003)  # no code, and the time-out of the whole goal


class RecoveryNode(py_trees.composites.Composite):
    """Ticks a child; when it fails, a recovery; and when that succeeds, the child again, up to a number of retries."""

    def __init__(self, name, retries, child, recovery):
        super().__init__(name, [child, recovery])
        self.retries = retries
        self.retried = 0

    def tick(self):
        if self.status != Status.RUNNING:
            self.current_child, self.retried = self.children[0], 0
        status = None
        while status is None:
            yield from self.current_child.tick()
            status = self.next_status()
        if status == Status.RUNNING:
            self.status = status
        else:
            self.stop(status)
        yield self

    def next_status(self):
        """Returns the status; None if it is the other child's turn."""
        child, recovery = self.children
        status = self.current_child.status
        if self.current_child is child and status == Status.FAILURE and self.retried < self.retries:
            self.current_child = recovery
        elif self.current_child is recovery and status == Status.SUCCESS:
            self.current_child = child
            self.retried += 1
        else:
            return status
        return None


class RoundRobin(py_trees.composites.Composite):
    """Ticks the child after the one that succeeded last; if a child fails, the next one. It fails if all children do."""

    def __init__(self, name, children):
        super().__init__(name, children)
        self.turn = self.failed = 0

    def tick(self):
        if self.status != Status.RUNNING:
            self.failed = 0
        status = Status.FAILURE
        while status == Status.FAILURE and self.failed < len(self.children):
            self.current_child = self.children[self.turn]
            yield from self.current_child.tick()
            status = self.current_child.status
            if status != Status.RUNNING:
                self.turn = (self.turn + 1) % len(self.children)
                self.failed += status == Status.FAILURE
        if status == Status.RUNNING:
            self.status = status
        else:
            self.stop(status)
        yield self

    def stop(self, new_status=Status.INVALID):
        # Not when a sequence that begins anew invalidates this node after its end: BehaviorTree.CPP halts what runs.
        if new_status == Status.FAILURE or (new_status == Status.INVALID and self.status == Status.RUNNING):
            self.turn = 0
        super().stop(new_status)


class NavigateWithRecovery(py_trees.behaviour.Behaviour):
    """A goal for `bt_navigator`: runs a tree of its own, anew for each goal, as Nav2 halts its tree after each."""

    def __init__(self, name, create_tree):
        super().__init__(name)
        self.create_tree = create_tree

    def initialise(self):
        self.tree = self.create_tree()

    def update(self):
        self.tree.tick_once()
        return self.tree.status

    def terminate(self, new_status):
        if self.status == Status.RUNNING and new_status == Status.INVALID:
            self.tree.stop(new_status)


class WouldARecoveryHelp(py_trees.behaviour.Behaviour):
    """Succeeds if the way was aborted with one of some error codes."""

    def __init__(self, name, way, codes):
        super().__init__(name)
        self.way = way
        self.codes = (*codes, *UNKNOWN)

    def update(self):
        aborted = self.way.ended is not None  # otherwise Nav2 has rejected the goal
        helps = aborted and self.way.ended.result().result.error_code in self.codes
        return Status.SUCCESS if helps else Status.FAILURE


class Clear(py_trees.behaviour.Behaviour):
    """Clears a costmap, and is running until Nav2 has answered."""

    def __init__(self, name, client):
        super().__init__(name)
        self.client = client

    def initialise(self):
        self.answer = self.client.call_async(ClearEntireCostmap.Request())

    def update(self):
        return Status.SUCCESS if self.answer.done() else Status.RUNNING


class Motion(py_trees.behaviour.Behaviour):
    """Sends a goal to a behaviour of Nav2, and is running until Nav2 has finished."""

    def __init__(self, name, client, goal):
        super().__init__(name)
        self.client = client
        self.goal = goal

    def initialise(self):
        self.sent = self.client.send_goal_async(self.goal)
        self.ended = None

    def update(self):
        if not self.sent.done():
            return Status.RUNNING
        if not self.sent.result().accepted:
            return Status.FAILURE
        if self.ended is None:
            self.ended = self.sent.result().get_result_async()
        if not self.ended.done():
            return Status.RUNNING
        succeeded = self.ended.result().status == GoalStatus.STATUS_SUCCEEDED
        return Status.SUCCESS if succeeded else Status.FAILURE

    def terminate(self, new_status):
        if self.status == Status.RUNNING and new_status == Status.INVALID:
            self.sent.add_done_callback(
                lambda sent: sent.result().accepted and sent.result().cancel_goal_async()
            )


class Recovering:
    """Mixed into the node of a task: each of its ways runs through the recovery tree."""

    def create_root(self):
        # A goal is tried again after each recovery. So as many attempts as without recoveries are fewer goals.
        self.attempts = math.ceil(self.attempts / (1 + RETRIES))
        self.spin = ActionClient(self, Spin, "spin")
        self.drive_on_heading = ActionClient(self, DriveOnHeading, "drive_on_heading")
        self.costmaps = {
            name: self.create_client(ClearEntireCostmap, f"{name}_costmap/clear_entirely_{name}_costmap")
            for name in ("global", "local")
        }
        return super().create_root()

    def create_way(self, name, place):
        way = super().create_way
        return NavigateWithRecovery(name, lambda: self.create_tree(way(name, place)))

    def create_tree(self, way):
        navigate = RecoveryNode("NavigateToPose", 1, way, self.create_context(way))
        recovery = sequence("Recovery", [would_any_help(way), self.create_recovery_actions()])
        return RecoveryNode("NavigateRecovery", RETRIES, navigate, recovery)

    def create_context(self, way):
        planner = sequence("Planner", [would_a_planner_help(way), self.clear("global")])
        controller = sequence("Controller", [would_a_controller_help(way), self.clear("local")])
        return fallback("Context", [planner, controller])

    def create_recovery_actions(self):
        spin = Spin.Goal(target_yaw=1.57)
        back_up = DriveOnHeading.Goal(speed=-0.15)
        back_up.target.x = -0.3
        spin.time_allowance.sec = back_up.time_allowance.sec = TIME_ALLOWANCE
        return RoundRobin(
            "RecoveryActions",
            [
                sequence("ClearingActions", [self.clear("local"), self.clear("global")]),
                Motion("Spin", self.spin, spin),
                py_trees.timers.Timer("Wait", 5.0),
                Motion("BackUp", self.drive_on_heading, back_up),
            ],
        )

    def clear(self, costmap):
        return Clear(f"Clear the {costmap} costmap", self.costmaps[costmap])


def would_any_help(way):
    return fallback("Would any help?", [would_a_controller_help(way), would_a_planner_help(way)])


def would_a_controller_help(way):
    return WouldARecoveryHelp("WouldAControllerRecoveryHelp", way, CONTROLLER)


def would_a_planner_help(way):
    return WouldARecoveryHelp("WouldAPlannerRecoveryHelp", way, PLANNER)


def sequence(name, children):
    return py_trees.composites.Sequence(name, memory=True, children=children)


def fallback(name, children):
    return py_trees.composites.Selector(name, memory=True, children=children)
