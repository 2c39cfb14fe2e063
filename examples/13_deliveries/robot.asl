// Deliveries: a robot that patrols a house, brings parcels for callers, and says why it does not.

{ include("$jacaros/artifacts.asl") }

/* What callers may use */

{ offer(goal, deliver(parcel(string), room([living_room, kitchen, bathroom]), percent(out(integer))),
        doc("Fetch a parcel from the hallway and bring it to a room. Returns the battery that this took, in percent."),
        when_busy(wait)) }
{ offer(belief, battery(level(integer(0, 100))), doc("The charge, in percent.")) }
{ offer(question, needs(room([living_room, kitchen, bathroom]), percent(out(integer))),
        doc("The battery that a delivery to a room needs, in percent.")) }
{ offer(tell, closed(room([living_room, kitchen, bathroom])), doc("The robot must not enter this room.")) }
{ offer(event, delivered(parcel(string), room(atom)), doc("A parcel is at its room.")) }

/* What the agent knows */

place(hallway, 0, 0, 0).  // x and y in metres, yaw in degrees
place(living_room, 2, 0, 90).
place(kitchen, 2, 2, 180).
place(bathroom, 0, 2, 270).
place(dock, 1, 1, 0).
reserve(20).  // percent that a delivery must leave

// From wherever it is to the hallway, and on to the room: 1.5 % per metre, and 0.3 % per second at 0.3 m/s.
needs(Room, Percent) :- place(Room, X, Y, _) & Percent = math.ceil(2.5 * (2.9 + math.sqrt(X ** 2 + Y ** 2))).

!start.

+!start
  <- !use_artifact("wheels", "ArtCmdVelMuxAndOdometry", [frame(map), stop_for(scan)]);
     !use_artifact("battery", "ArtSimBattery", [source(robot)]);
     !!patrol([living_room, kitchen, bathroom, hallway]).

+!drive_there(X, Y, _) <- driveTo(X, Y).

/* Deliveries, which are more urgent than the patrol. The first plans do not act, so the goal is refused, not failed. */

+!deliver(_, _, _) : not battery(_) <- .refuse(starting).  // a caller that comes before the robot is ready
+!deliver(_, Room, _) : closed(Room)[source(Who)] <- .refuse(closed(Room, Who)).
+!deliver(_, Room, _) : needs(Room, Percent) & battery(Left) & reserve(Least) & Left - Percent < Least
  <- .refuse(battery(Left, needs(Percent + Least))).
@deliver[urgency(5), needs(wheels)]
+!deliver(Parcel, Room, Percent)
  <- ?battery(Before);
     !go_to(hallway);
     .progress(0.5, "has the parcel");
     !go_to(Room);
     ?battery(After);
     Percent = Before - After;
     .print(Parcel, " is in the ", Room);
     .announce(delivered(Parcel, Room)).

/* The battery */

@charge[urgency(10)] +diagnostics("Low Battery") <- !charge_first.
+!drive_into_dock <- !go_to(dock).
+!wait_until_charged <- .print("charging"); operationRecharge.
+!drive_out_of_dock.

{ include("$jacaros/navigation.asl") }
