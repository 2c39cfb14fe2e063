// Counts with action servers of other processes, which complete, reject, abort and die.
!begin.

+!begin
  <- makeArtifact("steady", "CountingRobot", [], Steady);
     makeArtifact("fickle", "CountingRobot", ["fickle"], Fickle);
     makeArtifact("mortal", "CountingRobot", ["mortal"], Mortal);
     focus(Steady);
     focus(Mortal);
     !count(Steady, 3, 0.1);
     !count(Steady, -1, 0.1);
     !count(Fickle, 3, 0.1);
     !hurry(Steady);
     !change_mind(Steady);
     !count(Mortal, 1000, 0.1);
     .print("counting without end");
     !count(Steady, 1001, 0.1).

+!count(Robot, Target, Period)
  <- count(Target, Period, Last)[artifact_id(Robot)];
     .print("counted to ", Last).

-!count(Robot, Target, Period)[error(Error), env_failure_reason(Reason)]
  <- .print(Error, " ", Reason).

+!hurry(Robot) <- countWithin(1, 1002, 0.1)[artifact_id(Robot)].

-!hurry(Robot)[error(Error), env_failure_reason(Reason)] <- .print(Error, " ", Reason).

+!change_mind(Robot)
  <- !!count(Robot, 1003, 0.1);
     .wait(current(5)[artifact_name(steady)]);
     .drop_intention(count(Robot, 1003, _));
     .print("changed my mind").

+current(5)[artifact_name(mortal)] <- .print("the mortal one counts").
