// Plans that create, find and focus artifacts.  Include them in a program:
//
//     { include("$jacaros/artifacts.asl") }
//
// and name each artifact that the program uses:
//
//     !use_artifact("wheels", "ArtCmdVel");
//     !use_artifact("battery", "ArtSimBattery", [source(robot)]);

/* Any artifact */

// Create an artifact with this name and type, unless it exists, and focus it: its properties become beliefs.
+!use_artifact(Name, Type)
  <- !use_artifact(Name, Type, []).

+!use_artifact(Name, Type, Parameters)
  <- !create_artifact(Name, Type, Parameters);
     ?artifact(Name, Id);
     focus(Id).

+!create_artifact(Name, Type, Parameters)
  <- makeArtifact(Name, Type, Parameters).

// The artifact exists, because another agent was faster: nothing to do.
-!create_artifact(_, _, _)[env_failure_reason(Reason)]
    : Reason = makeArtifactFailure("artifact_already_present", _).

// Pass any other failure to the goal that posted this one.
-!create_artifact(_, _, _)[error(Error), error_msg(Text), env_failure_reason(Reason)]
  <- .fail(error(Error), error_msg(Text), env_failure_reason(Reason)).

// A program's own plan for creating artifacts may fail without a reason from the environment.
-!create_artifact(_, _, _)[error(Error), error_msg(Text)]
  <- .fail(error(Error), error_msg(Text)).

// Find an artifact; wait up to five seconds for it to be created.
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

/* The artifacts of the thesis, under the names of its plans: create_... creates and tool... finds an artifact */

// The position of the robot: odom(X, Y, Z).
+!create_odom <- !create_artifact("Odom", "ArtOdometry", []).
+!create_odom(Robot)
  <- .concat("Odom", Robot, Name);
     !create_artifact(Name, "ArtOdometry", [Robot]).
+?toolOdom(Id) <- ?artifact("Odom", Id).
+?toolOdom(Robot, Id) <- .concat("Odom", Robot, Name); ?artifact(Name, Id).

// Driving by time: move(N), rotate(Degrees).
+!create_cmd_vel <- !create_artifact("Cmd_vel", "ArtCmdVel", []).
+?toolCmd_vel(Id) <- ?artifact("Cmd_vel", Id).

// Driving by odometry: moveForward(Metres), rotate(Degrees), driveTo(X, Y).
+!create_cmd_vel_odom <- !create_artifact("Cmd_vel_odom", "ArtCmdVelAndOdometry", []).
+?toolCmd_vel_odom(Id) <- ?artifact("Cmd_vel_odom", Id).

// The same, on the topic of a Kobuki base.
+!create_cmd_vel_mux_odom <- !create_artifact("Cmd_vel_mux_odom", "ArtCmdVelMuxAndOdometry", []).
+?toolCmd_vel_mux_odom(Id) <- ?artifact("Cmd_vel_mux_odom", Id).

// A battery that a timer drains: battery(Percent), diagnostics(Text).
+!create_battery <- !create_artifact("Battery", "ArtSimBattery", []).
+?toolBattery(Id) <- ?artifact("Battery", Id).

// The household: clean(Room), vacuum, mop, scrub.
+!create_cleaner <- !create_artifact("Cleaner", "ArtCleaning", []).
+?toolCleaner(Id) <- ?artifact("Cleaner", Id).
