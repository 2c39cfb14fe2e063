"""Plans that share a robot: the more urgent one drives, and what it has interrupted goes on afterwards."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from jacaros.testing import RunResult, run_project

WORLD = """
name: big
bounds: {from: [-30, -30], to: [30, 30]}
robots: [{name: turtlebot, pose: {x: 0, y: 0}}]
"""

WHEELS = '!start. +!start <- makeArtifact("wheels","ArtCmdVel",[],W); focus(W); !go. '


Run = Callable[..., RunResult]


@pytest.fixture
def run(tmp_path: Path) -> Run:
    """Runs a program with a robot on a wide floor."""
    (tmp_path / "big.yaml").write_text(WORLD, encoding="utf-8")

    def run(program: str, **options: Any) -> RunResult:
        (tmp_path / "robot.asl").write_text(program, encoding="utf-8")
        return run_project(
            tmp_path / "robot.asl", **{"seconds": 300, "world": tmp_path / "big.yaml", **options}
        )

    return run


@pytest.fixture
def drive(run: Run) -> Run:
    """Runs a program whose goal is ``!go`` when it has the wheels."""
    return lambda program: run(WHEELS + program)


def test_an_urgent_plan_has_the_wheels_and_the_tour_is_finished_afterwards(drive: Run) -> None:
    result = drive("""
        +!go <- !!tour; .wait(2000); !!flee.
        +!tour <- driveTo(20,0); .print("tour done"); .stopMAS.
        @flee[urgency(100)]
        +!flee <- moveReverse(0.5); getCurrentPose(X,_,_); .print("fled").
        """)
    assert result.of("robot") == ["fled", "tour done"]
    assert result.ground_truth.latest().x == pytest.approx(20, abs=0.05)
    fled = [s.time for s in result.ground_truth.path() if s.x < 0.8 and s.time > 3]
    assert fled[0] < 7, "it need not wait for the twenty metres"


def test_a_repeated_velocity_gives_way_too(run: Run, drive: Run, tmp_path: Path) -> None:
    (tmp_path / "drive.yaml").write_text("""
operations:
  drive:
    parameters: [speed, seconds]
    publish: cmd_vel
    type: geometry_msgs/msg/Twist
    fields: {linear.x: $speed}
    rate: 10
    duration: $seconds
""")
    result = run("""
        !start.
        +!start <- makeArtifact("base", "drive.yaml", [], B); focus(B); !!forth; .wait(1000); !!back.
        +!forth <- drive(0.5,5); .print("forth done"); .stopMAS.
        @b[urgency(100)] +!back <- drive(-0.5,2); .print("back done").
        """)
    assert result.of("robot") == ["back done", "forth done"]


def test_an_urgent_navigation_is_not_preempted_by_a_later_one(run: Run) -> None:
    result = run(
        """
        !start.
        +!start <- makeArtifact("nav", "nav2.yaml", [], N); focus(N); .wait(pose(_,_,_));
                   !!evacuate; .wait(1500); !!dust.
        @e[urgency(100)]
        +!evacuate <- navigate_to(2,2,0); .print("evacuated").
        -!evacuate[env_failure_reason(R)] <- .print("evacuation failed: ",R).
        +!dust <- navigate_to(0,2,0); .print("dusted"); .stopMAS.
        """,
        world="patrol",
    )
    assert result.of("robot") == ["evacuated", "dusted"]


def test_a_preempted_plan_is_suspended_and_resume_does_not_let_it_drive(drive: Run) -> None:
    result = drive("""
        +!go <- !!tour; .wait(2000); !!flee; .wait(200); .suspended(tour,R); .print(R);
                .resume(tour); .wait(500); .suspended(tour,S); .print(S).
        ^!tour[state(suspended)[reason(R)]] <- .print("suspended: ", R).
        ^!tour[state(resumed)[reason(R)]] <- .print("resumed: ", R).
        +!tour <- driveTo(3,0); .print("tour done"); .stopMAS.
        @flee[urgency(100)]
        +!flee <- moveReverse(0.5); .print("fled").
        """)
    assert result.of("robot") == [
        *("suspended: preempted(wheels)", "preempted(wheels)", "preempted(wheels)", "fled"),
        *("resumed: preempted(wheels)", "tour done"),
    ]


def test_a_plan_that_needs_the_wheels_keeps_them_between_its_motions(drive: Run) -> None:
    result = drive("""
        +!go <- !!square; .wait(500); !!other; .wait({+finished}); .wait(20000); .stopMAS.
        @square[needs(wheels)]
        +!square <- moveForward(0.3); .wait(1000); !side; .print("square done"); +finished.
        +!side <- moveForward(0.3); .wait(1000).
        +!other <- moveForward(0.3); .print("other done").
        """)
    assert result.of("robot") == ["square done", "other done"]


def test_needs_of_a_goal_are_given_back_however_it_ends(run: Run) -> None:
    result = run("""
        !start.
        +!start <- !!one; .wait(100); !!two; .wait(1000); .suspended(two, R); .print(R); .drop_intention(one);
                   .wait(500); !!three; .wait(500); .fail_goal(two); .wait(500); .stopMAS.
        +!one <- !work[needs(base, arm)]; .print(never).
        +!two <- !work(2)[needs(arm)].
        +!work <- .print(one); .wait(100000).
        +!work(N) <- .print(N); .wait(100000).
        -!two <- .print("two failed").
        @three[needs(arm)] +!three <- .print(three).
        """)
    assert result.of("robot") == ["one", "needs(arm)", "2", "two failed", "three"]


@pytest.mark.parametrize("needs", ["", ", needs(wheels)"], ids=["uses", "needs"])
def test_an_atomic_plan_has_the_wheels_that_another_plan_of_its_agent_holds(drive: Run, needs: str) -> None:
    result = drive(
        """
        +!go <- !!square; .wait(5000); !dock; .wait({+finished}); .stopMAS.
        @square[needs(wheels), urgency(5)]
        +!square <- moveForward(0.2); .wait(9000); .print("square done"); +finished.
        @dock[atomic NEEDS]
        +!dock <- .print("docks"); moveForward(0.2); .print("docked").
        ^!square[state(S)[reason(preempted(R))]] <- .print("square ", S, ": ", R).
        """.replace(" NEEDS", needs)
    )
    assert sorted(result.of("robot")) == [
        *("docked", "docks", "square done", "square resumed: wheels", "square suspended: wheels")
    ]
    assert result.of("robot")[-1] == "square done"
    assert result.errors == []


def test_policies_decide_what_happens_when_a_resource_is_taken(run: Run) -> None:
    result = run("""
        !start.
        +!start <- !!one; .wait(100); !two; !!three; .wait(3000); .stopMAS.
        @one[needs(arm)] +!one <- .print(one); .wait(1000); .print("one done").
        @two[needs(arm), policy(refuse)] +!two <- .print(never).
        -!two[env_failure_reason(R)] <- .print(R).
        @three[needs(arm), urgency(1)] +!three <- .print(three); .wait(500); .print("three done").
        """)
    assert result.of("robot") == ["one", "resource_busy(arm)", "three", "three done", "one done"]


def test_the_full_name_refers_to_the_robot_without_a_namespace(run: Run) -> None:
    result = run("""
        !start.
        +!start
          <- makeArtifact("guest", "turtlebot4.yaml", ["robot_7"], G); focus(G);
             makeArtifact("wheels", "ArtCmdVel", [], W); focus(W);
             !go[needs(wheels)];
             .stopMAS.
        +!go <- moveForward(1); .print("there").
        """)
    assert result.of("robot") == ["there"]


def test_the_wheels_of_one_of_two_named_robots_are_ambiguous(run: Run) -> None:
    result = run("""
        !start.
        +!start
          <- makeArtifact("left", "turtlebot4.yaml", ["robot_1"], L); focus(L);
             makeArtifact("right", "turtlebot4.yaml", ["robot_2"], R); focus(R);
             !go[needs(wheels)].
        -!start[env_failure_reason(Why)] <- .print(Why); .stopMAS.
        +!go <- .print("no").
        """)
    assert result.of("robot") == ["ambiguous_resource(wheels)"]


def test_two_plans_that_wait_for_each_other_are_reported(run: Run) -> None:
    result = run("""
        !start.
        +!start <- !!one; !!two; .wait(5000); .stopMAS.
        @one[needs(base)] +!one <- .wait(500); !inner[needs(arm)]; .print("one done").
        @two[needs(arm)] +!two <- .wait(500); !inner[needs(base)]; .print("two done").
        -!two[env_failure_reason(R)] <- .print(R).
        +!inner <- .wait(10).
        """)
    assert result.of("robot") == ["deadlock(base)", "one done"]
    assert any("deadlock: [robot] !inner waits for base" in line for line in result.errors)


def test_a_suspended_plan_lets_others_have_what_it_needs(run: Run) -> None:
    result = run("""
        !start.
        +!start <- !!one; .wait(200); .suspend(one); !!two; .wait(200); .resume(one); .wait(100);
                   .suspended(one, R); .print(R); .wait(3000); .stopMAS.
        @one[needs(arm)] +!one <- .print(one); .wait(1000); .print("one done").
        @two[needs(arm)] +!two <- .print(two); .wait(1000); .print("two done").
        """)
    assert result.of("robot") == ["one", "two", "preempted(arm)", "two done", "one done"]


def test_two_agents_share_a_lift_and_the_end_of_one_frees_it(tmp_path: Path) -> None:
    (tmp_path / "rider.asl").write_text("""
        +!ride[source(_)] <- !in.
        @in[needs(lift)] +!in <- .my_name(Me); .print("in"); .wait(1000000).
        """)
    (tmp_path / "boss.asl").write_text("""
        !start.
        +!start <- .send(one, achieve, ride); .wait(100); .send(two, achieve, ride); .wait(1000);
                   .print("one ends"); .kill_agent(one); .wait(1000); .stopMAS.
        """)
    file = tmp_path / "lift.mas2j"
    agents = "boss; one rider.asl; two rider.asl;"
    file.write_text(f"MAS lift {{ environment: jacaros.Environment agents: {agents} }}")
    result = run_project(file, seconds=60)
    assert result.lines == ["[one] in", "[boss] one ends", "[two] in"]


ARTIFACTS = '''
import random

from jacaros.artifacts import Artifact, operation

BRAKING = 0.5


class Body(Artifact):
    """A base and an arm that fail now and then, and a book of who asked, began and ended."""

    def init(self):
        self.chance = random.Random(7)
        self.asked, self.late, self.open, self.free = {}, 0.0, {}, 0.0

    @operation(uses="base", pausable=True)
    async def drive(self, who, seconds):
        await self.work(seconds)

    @operation(uses="arm", pausable=True)
    async def grasp(self, who, seconds):
        await self.work(seconds)

    async def work(self, seconds):
        if self.chance.random() < 0.1:
            self.fail("it broke", "broken")
        left = float(seconds)
        while left > 1e-6:
            if self.current.paused:
                await self.sleep(BRAKING)
                await self.pause_point()
            await self.sleep(0.25)
            left -= 0.25

    @operation
    def ask(self, who, number):
        self.asked[who, number] = self.clock.elapsed
        self.open[who, number] = True

    @operation
    def got(self, who, number):
        if who == "high":
            since = max(self.free, self.asked[who, number])  # another urgent plan has its turn first
            self.late = max(self.late, self.clock.elapsed - since)

    @operation
    def over(self, who, number):
        self.open.pop((who, number), None)
        if who == "high":
            self.free = self.clock.elapsed

    @operation
    def report(self):
        self.signal("report", len(self.asked), round(self.late, 3), len(self.open))
'''

HOUR = """
!start.
+!start <- makeArtifact("body", "Body", [], B); focus(B); !!ask(low, 40, 80000); !!ask(middle, 40, 80000);
           !!ask(high, 40, 80000); !!chaos(60); .wait(3600000); report.
+report(N, Late, Left) <- .print(N, " ", Late, " ", Left); .stopMAS.

+!ask(Who, 0, _).
+!ask(Who, N, Pause) <- .random(R); .wait(Pause * R); !asked(Who, N); !ask(Who, N-1, Pause).
@asked[atomic] +!asked(Who, N) <- ask(Who, N); !begin(Who, N).
+!begin(low, N) <- !!low(N).
+!begin(middle, N) <- !!middle(N).
+!begin(high, N) <- !!high(N).

@low[needs(base, arm)] +!low(N) <- got(low, N); drive(low, 7); .wait(500); grasp(low, 6); over(low, N).
-!low(N) <- !low(N).
@middle[needs(arm), urgency(5)] +!middle(N) <- got(middle, N); grasp(middle, 4); drive(middle, 4); over(middle, N).
-!middle(N) <- !middle(N).
@high[needs(base, arm), urgency(100)] +!high(N) <- got(high, N); drive(high, 2); grasp(high, 2); over(high, N).
@failed[urgency(100)] -!high(N) <- over(high, N).

+!chaos(0).
+!chaos(N) <- .random(R); .wait(50000 * R); .random(Q); I = math.floor(Q * 40) + 1; !drop(I); !chaos(N-1).
+!drop(I) : .intend(low(I)) <- .drop_intention(low(I)); over(low, I).
+!drop(_).
"""


def test_three_plans_compete_for_base_and_arm_for_an_hour(run: Run, tmp_path: Path) -> None:
    (tmp_path / "artifacts.py").write_text(ARTIFACTS, encoding="utf-8")
    result = run(HOUR, seconds=3700, seed=3)
    (line,) = result.of("robot")
    asked, late, left = line.split()
    assert int(asked) == 120
    assert float(late) <= 0.5 + 0.25 + 1e-6, "braking, and one step of it"
    assert int(left) == 0, "all that was interrupted has been finished"
