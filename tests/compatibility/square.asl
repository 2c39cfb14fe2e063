// As listing 20: a square by odometry.
// jacaros: ignore-file singleton-variable

!start.

+!create_cmd_vel_mux_odom
  <- makeArtifact("Cmd_vel_mux_odom", "jason.architecture.ArtCmdVelMuxAndOdometry", [],
                  CmdVelMuxId).

-!create_cmd_vel_mux_odom
  <- .print("no artifact for driving").

+?toolCmd_vel_mux_odom(CmdVelMuxId)
  <- lookupArtifact("Cmd_vel_mux_odom", CmdVelMuxId).

-?toolCmd_vel_mux_odom(CmdVelMuxId)
  <- .wait(10);
     ?toolCmd_vel_mux_odom(CmdVelMuxId).

+!start
  <- !create_cmd_vel_mux_odom;
     ?toolCmd_vel_mux_odom(CmdVelMuxId);
     focus(CmdVelMuxId);
     for (.range(I, 1, 4)) {  // the sides
        moveForward(1);
        rotate(90);
     }.
