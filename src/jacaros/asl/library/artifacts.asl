// Plans that make, find and focus artifacts.  A program takes them in by
//
//     { include("$jacaros/artifacts.asl") }
//
// and says what it wants to use, each artifact by a name of its own choice:
//
//     !use_artifact("wheels", "ArtCmdVel");
//     !use_artifact("battery", "ArtSimBattery", [source(robot)]);

/* Any artifact */

// Have an artifact of this name and type, and perceive it: its properties become beliefs.
+!use_artifact(Name, Type)
  <- !use_artifact(Name, Type, []).

+!use_artifact(Name, Type, Parameters)
  <- !create_artifact(Name, Type, Parameters);
     ?artifact(Name, Id);
     focus(Id).

+!create_artifact(Name, Type, Parameters)
  <- makeArtifact(Name, Type, Parameters).

// It is there already, another agent was faster: just as well.
-!create_artifact(_, _, _)[env_failure_reason(Reason)]
    : Reason = makeArtifactFailure("artifact_already_present", _).

// Any other reason concerns who wanted the artifact.
-!create_artifact(_, _, _)[error(Error), error_msg(Text), env_failure_reason(Reason)]
  <- .fail(error(Error), error_msg(Text), env_failure_reason(Reason)).

// A program that makes artifacts in its own way may fail without a reason of the environment.
-!create_artifact(_, _, _)[error(Error), error_msg(Text)]
  <- .fail(error(Error), error_msg(Text)).

// Find an artifact; one that is not there yet has five seconds to come.
+?artifact(Name, Id)
  <- ?artifact(Name, Id, 50).

+?artifact(Name, Id, _)
  <- lookupArtifact(Name, Id).

-?artifact(Name, Id, Tries) : Tries > 1
  <- .wait(100);
     ?artifact(Name, Id, Tries - 1).

-?artifact(_, _, _)[error(Error), error_msg(Text), env_failure_reason(Reason)]
  <- .fail(error(Error), error_msg(Text), env_failure_reason(Reason)).

-?artifact(_, _, _)[error(Error), error_msg(Text)]
  <- .fail(error(Error), error_msg(Text)).

/* The artifacts of the thesis, by the names of its plans: make with create_..., find with tool... */

// Where the robot is: odom(X, Y, Z).
+!create_odom <- !create_artifact("Odom", "ArtOdometry", []).
+!create_odom(Robot)
  <- .concat("Odom", Robot, Name);
     !create_artifact(Name, "ArtOdometry", [Robot]).
+?toolOdom(Id) <- ?artifact("Odom", Id).
+?toolOdom(Robot, Id) <- .concat("Odom", Robot, Name); ?artifact(Name, Id).

// Driving, by time: move(N), rotate(Degrees).
+!create_cmd_vel <- !create_artifact("Cmd_vel", "ArtCmdVel", []).
+?toolCmd_vel(Id) <- ?artifact("Cmd_vel", Id).

// Driving by odometry: moveForward(Metres), rotate(Degrees), driveTo(X, Y).
+!create_cmd_vel_odom <- !create_artifact("Cmd_vel_odom", "ArtCmdVelAndOdometry", []).
+?toolCmd_vel_odom(Id) <- ?artifact("Cmd_vel_odom", Id).

// The same by the topic of a Kobuki base.
+!create_cmd_vel_mux_odom <- !create_artifact("Cmd_vel_mux_odom", "ArtCmdVelMuxAndOdometry", []).
+?toolCmd_vel_mux_odom(Id) <- ?artifact("Cmd_vel_mux_odom", Id).

// A battery that a timer drains: battery(Percent), diagnostics(Text).
+!create_battery <- !create_artifact("Battery", "ArtSimBattery", []).
+?toolBattery(Id) <- ?artifact("Battery", Id).

// The household: clean(Room), vacuum, mop, scrub.
+!create_cleaner <- !create_artifact("Cleaner", "ArtCleaning", []).
+?toolCleaner(Id) <- ?artifact("Cleaner", Id).
