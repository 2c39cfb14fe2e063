// A robot that cleans the rooms of a building together with all others that are there. One of them calls for proposals for
// each room, and the nearest free robot gets it (contract net). Every robot has a map, and observes the maps of the others.

/* What the agent knows */

room(library, -1.8, 1).  // x and y in metres
room(office, -0.6, 1).
room(studio, 0.6, 1).
room(gallery, 1.8, 1).
room(kitchen, -1.8, -1).
room(pantry, -0.6, -1).
room(archive, 0.6, -1).
room(workshop, 1.8, -1).

at(0, 0).   // where the robot was last
robots(3).  // how many there are

// The maps show here(Robot), taken(Room, Robot) and clean(Room, Robot).
open(Room) :- room(Room, _, _) & not clean(Room, _) & not taken(Room, _).
all_clean :- not (room(Room, _, _) & not clean(Room, _)).
busy :- .my_name(Me) & taken(_, Me).
metres_to(Room, Metres)
    :- room(Room, X, Y) & at(Px, Py) & Metres = math.round(10 * math.sqrt((X - Px) ** 2 + (Y - Py) ** 2)) / 10.

// The first of the robots that are there is the manager. If it is lost, the next one is.
is_manager :- .my_name(Me) & .df_search("cleaning", Robots) & .min(Robots, Me).

!start.

+!start : robots(N)
  <- .df_register("cleaning");
     .my_name(Me);
     enter[wsp(Me)];
     .wait(.count(here(_), N), 10000, _);  // until all are there, or 10 s have passed
     !!share_work.

/* The manager */

+!share_work : all_clean
  <- .print("the building is clean");
     .stopMAS.

+!share_work : is_manager & open(Room)
  <- !assign(Room);
     !!share_work.

+!share_work
  <- .wait(500);
     !!share_work.

+!assign(Room)
  <- .abolish(propose(Room, _, _));
     .abolish(refuse(Room, _));
     .df_search("cleaning", Robots);
     .send(Robots, achieve, cfp(Room));
     .wait(all_answered(Room, Robots), 1000, _);  // the deadline
     .findall(offer(Metres, Robot), propose(Room, Metres, Robot), Offers);
     !accept(Room, Offers).

all_answered(Room, Robots) :- .count(propose(Room, _, _) | refuse(Room, _), N) & .length(Robots, N).

+!accept(_, [])
  <- .wait(1000).  // all are busy

+!accept(Room, Offers)
  <- .min(Offers, offer(Metres, Robot));
     .print("the ", Room, " goes to ", Robot, ", ", Metres, " m away");
     .send(Robot, achieve, accept_proposal(Room));
     .wait(not open(Room), 1000, _).  // until the map shows it

// A robot was lost meanwhile: the next call is without it.
-!assign(_)
  <- .wait(500).

/* Each robot, and the manager is one of them */

+!cfp(Room)[source(Manager)] : open(Room) & not busy & metres_to(Room, Metres)
  <- .my_name(Me);
     .send(Manager, tell, propose(Room, Metres, Me)).

+!cfp(Room)[source(Manager)]
  <- .my_name(Me);
     .send(Manager, tell, refuse(Room, Me)).

+!accept_proposal(Room) : open(Room) & not busy & room(Room, X, Y)
  <- .my_name(Me);
     take(Room)[wsp(Me)];
     .print("I go to the ", Room);
     driveTo(X, Y);
     -+at(X, Y);
     use_tool("vacuum");
     .wait(2000);
     use_tool("");
     .print("the ", Room, " is clean");
     note(Room, Me)[wsp(Me)];
     leave(Room)[wsp(Me)].

+!accept_proposal(_).  // the robot has another room: the manager calls again

-!accept_proposal(Room)[error_msg(Text)]
  <- .print("I cannot clean the ", Room, ": ", Text);
     use_tool("");
     .my_name(Me);
     leave(Room)[wsp(Me)].

/* The maps */

// Copy what the others show, so that no robot has the only map.
+clean(Room, Robot)
  <- .my_name(Me);
     note(Room, Robot)[wsp(Me)].

// What a robot has taken vanishes with its map, so the room is open again.
-taken(Room, Robot) : not clean(Room, _) & not .my_name(Robot)
  <- .print(Robot, " has left the ", Room).
