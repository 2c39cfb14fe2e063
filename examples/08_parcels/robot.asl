// The robot: drives to the rooms it is sent to, loads and unloads there, and recharges when its battery is low.

{ include("$jacaros/artifacts.asl") }
{ include("$jacaros/help.asl") }

/* What the agent knows */

place(hallway, 0, 0).  // name, x and y in metres
place(living_room, 2, 0).
place(kitchen, 2, 2).
place(bathroom, 0, 2).
place(dock, 1, 1).
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
  <- -+bound(Room);                 // where to return after a recharge
     !drive(Room)[retry(6, 1000)];  // for a minute: what is in the way may go
     !exchange(Room);
     -+at(Room);
     .send(Sender, tell, visited(Room)).

+!drive(Place) : place(Place, X, Y) <- driveTo(X, Y).

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

+!recharge : recharges(N)
  <- !drive(dock)[retry(6, 1000)];
     operationRecharge;
     -+recharges(N + 1).

+!return : bound(Room) <- !drive(Room)[retry(6, 1000)].
+!return.

/* Failures: something stays in the way, or the robot missed the dock; a person helps, or the run ends with exit status 1 */

-!drive(Place)[error_msg(Text)]
  <- !help_or_stop(Text);
     !drive(Place).

-!recharge[error_msg(Text)]
  <- !help_or_stop(Text);
     !recharge.
