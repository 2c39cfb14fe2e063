// Carries things between the places of a building: opens doors on the way, looks for things in closets, and recharges.
//
// A program that includes this has a plan for `!serve`, and says where it believes things to be: at(tea, shelf).

/* Where this robot does otherwise than the library */

+!drive_into_dock
  <- !be_at(dock);
     dock_at("dock").

+!drive_out_of_dock <- leave_dock.

{ include("$jacaros/artifacts.asl") }
{ include("$jacaros/navigation.asl") }
{ include("building.asl") }

attempts(15).
low_at(40).

open(Door) :- is_open(true)[artifact_name(Door)].

!start.

+!start
  <- !perceive;
     !serve;
     .stopMAS.

// What is done already is not done again.
-!start[error_msg(Text)]
  <- !help_or_stop(Text);
     .abolish(searched(_));
     !start.

+!perceive
  <- !use_artifact(operator, "Operator");
     !use_artifact(eyes, "ArtPerception", [split(true)]);
     for (behind(_, Door)) {
        .concat("doors/", Door, Name);
        !use_artifact(Door, "../door.yaml", [Name])
     };
     .wait(pose(_, _, _)).

/* Places and doors */

+!be_at(Place) : battery_low & not .desire(dock_and_charge)
  <- !dock_and_charge;
     !be_at(Place).

+!be_at(Place) : behind(Place, Door) & not open(Door)
  <- !open(Door);
     !be_at(Place).

+!be_at(Place) <- !go_to(Place).

+!open(Door) : open(Door).
+!open(Door)
  <- !be_at(front(Door));
     !attempt(pull(Door), 1).

+!close(Door) : not open(Door).
+!close(Door)
  <- !be_at(front(Door));
     !attempt(push(Door), 1).

+!pull(Door) <- open_door[artifact_name(Door)].
+!push(Door) <- close_door[artifact_name(Door)].

/* Things */

+!bring(Thing, Place) : at(Thing, Place).
+!bring(Thing, Place)
  <- !fetch(Thing);
     !be_at(Place);
     !attempt(release, 1);
     -at(Thing, gripper);
     +at(Thing, Place);
     .print("the ", Thing, " is in its place: ", Place).

+!fetch(Thing) : at(Thing, gripper).
+!fetch(Thing) : at(Thing, Place)
  <- !be_at(Place);
     !attempt(take(Taken), 1);
     -at(Thing, Place);
     if (Taken == false) {
        .print("no ", Thing, " at the ", Place);
        !attempt(release, 1);
        !fetch(Thing)
     } else {
        +at(Thing, gripper)
     }.

+!fetch(Thing) : may_hold(Closet) & not searched(Closet)
  <- !search(Closet);
     !fetch(Thing).

+!fetch(Thing)
  <- .concat("the ", Thing, " is nowhere", Text);
     .fail(error(not_found), error_msg(Text), env_failure_reason(not_found(Thing))).

+!take(Taken) <- grip(0, Taken).
+!release <- grip(0.1, _).

// What is seen before the open closet is in it.
+!search(Closet)
  <- !open(Closet);
     !be_at(front(Closet));
     .wait(3000);
     for (perception(Name, Ahead, _, _) & Ahead < 1.2) {
        .term2string(Thing, Name);
        +at(Thing, Closet)
     };
     +searched(Closet).
