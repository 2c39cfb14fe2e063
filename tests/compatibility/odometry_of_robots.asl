// As listings 7 and 8: one odometry artifact per robot, named after the robot; empty brackets.
// jacaros: ignore-file missing-context, empty-brackets, singleton-variable

!start.

+!create_odom(AgentName, OdomId) :
  <- .concat("Odom", AgentName, Result);
     .print("making ", Result);
     makeArtifact(Result, "jason.architecture.ArtOdometry", [AgentName], OdomId).

+!create_odom :
  <- .print("making Odom");
     makeArtifact("Odom", "jason.architecture.ArtOdometry", [], OdomId).

+?toolOdom(AgentName, OdomId) : true
  <- .concat("Odom", AgentName, Result);
     .print("looking up ", Result);
     lookupArtifact(Result, OdomId).

+?toolOdom(OdomId) :
  <- .print("looking up Odom");
     lookupArtifact("Odom", OdomId).

+odom(A, B, C)
  <- -+currentPose(A, B, C).

+!start
  <- !create_odom();
     ?toolOdom(OdomID);
     focus(OdomID);
     stopFocus(OdomID);
     !create_odom("robot_1", Made);
     ?toolOdom("robot_1", Found);
     focus(Found);
     .wait(currentPose(X, Y, Z) & X \== 0);
     .print("robot_1 is at ", X, " ", Y);
     if (Made == Found) { .print("found what it made") };
     .stopMAS.
