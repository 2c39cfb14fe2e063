// The robot: drives to the rooms it is sent to, loads and unloads there, and recharges when its battery is low.

{ include("$jacaros/artifacts.asl") }

/* What the agent knows */

place(hallway, 0, 0).  // name, x and y in metres
place(living_room, 2, 0).
place(kitchen, 2, 2).
place(bathroom, 0, 2).
dock(1, 1).
at(hallway).
recharges(0).

!start.

+!start
  <- !use_artifact("wheels", "ArtCmdVelMuxAndOdometry", [frame(map)]);  // wheels slip
     !use_artifact("battery", "ArtSimBattery", [source(robot)]).

/* Visiting a room for the dispatcher */

// Needs the wheels until all parcels are unloaded and loaded.
@visit[needs(wheels)]
+!visit(Room)[source(Sender)]
  <- -+bound(Room);  // where to return after a recharge
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

/* Failures: the robot missed the dock, or its path was blocked */

-!recharge[error_msg(Text)]
  <- !give_up(Text).

-!visit(_)[error_msg(Text)]
  <- !give_up(Text).

+!give_up(Text)
  <- .print("I need help: ", Text);
     .stopMAS(0, 1).  // the exit status reports the failure
