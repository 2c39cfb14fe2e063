// The robot: goes where it is sent, loads and unloads there, and minds its battery.

{ include("$jacaros/artifacts.asl") }

/* What the agent knows */

place(hallway, 0, 0).  // rooms, in metres
place(living_room, 2, 0).
place(kitchen, 2, 2).
place(bathroom, 0, 2).
dock(1, 1).
at(hallway).
recharges(0).

!start.

+!start
  <- !use_artifact("wheels", "ArtCmdVelMuxAndOdometry");
     !use_artifact("battery", "ArtSimBattery", [source(robot)]).

/* To a room, on behalf of the dispatcher */

// The wheels are needed until the parcels are out and in.
@visit[needs(wheels)]
+!visit(Room)[source(Sender)]
  <- -+bound(Room);  // so that it finds its way after a recharge
     ?place(Room, X, Y);
     driveTo(X, Y);
     !exchange(Room);
     -+at(Room);
     .send(Sender, tell, visited(Room)).

+!exchange(Room)
  <- for (aboard(Number, Room)) {
        unload(Number);
        .print("parcel ", Number, " has arrived in the ", Room)
     };
     for (parcel(Number, Room, To)) {
        load(Number);
        .print("parcel ", Number, " goes to the ", To)
     }.

/* The battery: more urgent than any parcel */

@charge[urgency(10)]
+diagnostics("Low Battery")
  <- .print("battery low");
     !charge_and_return[needs(wheels)].

+!charge_and_return
  <- !recharge;
     .print("battery full");
     !return.

+!recharge : dock(X, Y) & recharges(N)
  <- driveTo(X, Y);
     operationRecharge;
     -+recharges(N + 1).

+!return : bound(Room) & place(Room, X, Y) <- driveTo(X, Y).
+!return.

/* Something went wrong: the robot missed the dock, or something stood in its way */

-!recharge[error_msg(Text)]
  <- !give_up(Text).

-!visit(_)[error_msg(Text)]
  <- !give_up(Text).

+!give_up(Text)
  <- .print("I need help: ", Text);
     .stopMAS(0, 1).  // the exit code tells that it went wrong
