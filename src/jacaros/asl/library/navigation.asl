// Plans of robots that go to places, patrol and recharge, over operations that a mapping or an artifact offers.  A program
// takes them in by
//
//     { include("$jacaros/navigation.asl") }
//
// and says what it knows of its world and how patient it is:
//
//     place(kitchen, 2, 2, 90).   // where to stand, in metres, and where to look, in degrees
//     attempts(5).                // so often a way is tried (3)
//     charged_at(100).            // percent at which the battery is full enough (95)
//
// A plan of the program that stands before the include goes first, so every step below can be done otherwise.

attempts_allowed(N) :- attempts(N).
attempts_allowed(3) :- not attempts(_).

full_enough(Percent) :- charged_at(Least) & Percent >= Least.
full_enough(Percent) :- not charged_at(_) & Percent >= 95.

/* Going somewhere */

// To a place by its name, or to a pose in the map: metres and degrees.
+!go_to(Place) : place(Place, X, Y, Yaw)
  <- !go_to(X, Y, Yaw).

+!go_to(Place)
  <- .concat("there is no belief place(", Place, ", X, Y, Yaw)", Text);
     .fail(error(unknown_place), error_msg(Text), env_failure_reason(unknown_place(Place))).

+!go_to(X, Y, Yaw)
  <- !go_to(X, Y, Yaw, 1).

+!go_to(X, Y, Yaw, _)
  <- !drive_there(X, Y, Yaw).

// It did not work: see what can be done about the reason, and try again.
-!go_to(X, Y, Yaw, Attempt)[env_failure_reason(Reason)]
    : attempts_allowed(Most) & Attempt < Most
  <- !recover(Reason);
     !go_to(X, Y, Yaw, Attempt + 1).

-!go_to(_, _, _, _)[error_msg(Text), env_failure_reason(Reason)]
  <- .fail(error(action_failed), error_msg(Text), env_failure_reason(Reason)).

// The one place that knows how this robot drives.
+!drive_there(X, Y, Yaw)
  <- navigate_to(X, Y, Yaw).

/* When the way failed */

// Somebody took the goal back, or the place is no place: trying again would be wrong.
+!recover(canceled)
  <- .fail(error(action_failed), error_msg("the way was cancelled"), env_failure_reason(canceled)).

// The server is starting, or is gone and may come back.
+!recover(Reason) : Reason = rejected | Reason = server_lost
  <- .wait(3000).

// No way was found, or it took too long: forget obstacles that may have gone, and give them time to go.
+!recover(_)
  <- !forget_obstacles;
     .wait(2000).

+!forget_obstacles
  <- clear_costmaps.

// Not every robot can: just as well.
-!forget_obstacles.

/* Patrol */

// From place to place, again and again.
+!patrol(Places)
  <- !round(Places);
     !!patrol(Places).

// So many rounds.
+!patrol(_, Rounds) : Rounds <= 0.

+!patrol(Places, Rounds)
  <- !round(Places);
     !patrol(Places, Rounds - 1).

+!round([]).

+!round([Place | Rest])
  <- !visit(Place);
     !round(Rest).

// Be there; a program that has something to do there has its own plan for `arrived`.
+!visit(Place)
  <- !go_to(Place);
     !arrived(Place).

// A place that cannot be reached is left out, and known.
-!visit(Place)[env_failure_reason(Reason)]
  <- .abolish(unreachable(Place, _));
     +unreachable(Place, Reason).

+!arrived(Place)
  <- .abolish(unreachable(Place, _)).

/* The battery */

// To the dock, wait there until the battery is full, and out again.  The battery is known as battery(Percent, _) or
// battery(Percent).
+!dock_and_charge
  <- !into_dock;
     !wait_until_charged;
     !out_of_dock.

// In front of the dock, if it is a place of the program's, and in.
+!into_dock : place(dock, X, Y, Yaw)
  <- !go_to(X, Y, Yaw);
     dock.

+!into_dock
  <- dock.

+!out_of_dock
  <- undock.

+!wait_until_charged : (battery(Percent, _) | battery(Percent)) & full_enough(Percent).

+!wait_until_charged
  <- .wait(1000);
     !wait_until_charged.
