// As listing 19: out and back by time.
// jacaros: ignore-file singleton-variable

!start.

+!create_cmd_vel
  <- makeArtifact("Cmd_vel", "jason.architecture.ArtCmdVel", [], CmdVelId).

-!create_cmd_vel
  <- .print("no artifact for driving").

+?toolCmd_vel(CmdVelId)
  <- lookupArtifact("Cmd_vel", CmdVelId).

-?toolCmd_vel(CmdVelId)
  <- .wait(10);
     ?toolCmd_vel(CmdVelId).

+!start
  <- !create_cmd_vel;
     ?toolCmd_vel(CmdVelId);
     focus(CmdVelId);
     for (.range(I, 1, 2)) {  // out, and back
        move(25);
        rotate(180);
     }.
