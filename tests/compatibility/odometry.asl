// As listing 26: odometry with and without the name of a robot, and plans with an empty context.
// jacaros: ignore-file missing-context, singleton-variable

!watch.

+!create_odom(AgentName) :
  <- .print("making the artifact of ", AgentName);
     makeArtifact("Odom", "jason.architecture.ArtOdometry", [AgentName], OdomId).

-!create_odom(AgentName) :
  <- .print("no odometry for ", AgentName).

+!create_odom :
  <- .print("making the artifact of a robot without a name");
     makeArtifact("Odom", "jason.architecture.ArtOdometry", [], OdomId).

-!create_odom :
  <- .print("no odometry").

+?toolOdom(OdomId) :
  <- .print("looking the artifact up");
     lookupArtifact("Odom", OdomId).

-?toolOdom(OdomId) :
  <- .print("looking again");
     .wait(10);
     ?toolOdom(OdomId).

+odom(A, B, C)
  <- .print("odometry came");
     println("X: ", A);
     println("Y: ", B);
     println("Z: ", C);
     -+currentPose(A, B, C).

+!make_late
  <- .wait(35);
     !create_odom.

+!watch
  <- !!make_late;  // so that the first look-up fails
     ?toolOdom(OdomId);
     focus(OdomId);
     .wait(currentPose(_, _, _));
     stopFocus(OdomId);
     ?currentPose(X, Y, Z);
     .print("the pose: ", X, " ", Y, " ", Z);
     !create_odom("robot_0");  // an artifact with that name exists
     .stopMAS.
