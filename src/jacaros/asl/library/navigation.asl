// Plans of robots that go to places, patrol and recharge, over operations that a mapping or an artifact offers.  A program
// takes them in by
//
//     { include("$jacaros/navigation.asl") }
//
// and says what it knows of its world and how patient it is:
//
//     place(kitchen, 2, 2, 90).   // where to stand, in metres, and where to look, in degrees
//     attempts(5).                // so often a way is tried (3)
//     low_at(30).                 // percent at which the battery is low (20)
//     charged_at(100).            // percent at which it is full enough (95)
//     dock_id("dock_1").          // how Nav2 calls the robot's dock, where Nav2 docks it
//
// A plan of the program that stands before the include goes first, so every step below can be done otherwise.

attempts_allowed(N) :- attempts(N).
attempts_allowed(3) :- not attempts(_).

percent_left(Percent) :- charge_told(Percent) & Percent <= 150.
percent_left(Percent) :- charge_told(Told) & Told > 150 & Percent = Told / 100.  // a driver that counts in percent itself
charge_told(Percent) :- battery(Percent, _).
charge_told(Percent) :- battery(Percent).

battery_low :- percent_left(Percent) & low_at(Least) & Percent <= Least.
battery_low :- percent_left(Percent) & not low_at(_) & Percent <= 20.

battery_full :- percent_left(Percent) & charged_at(Least) & Percent >= Least.
battery_full :- percent_left(Percent) & not charged_at(_) & Percent >= 95.

/* Going somewhere */

// To a place by its name, or to a pose in the map: metres and degrees.
+!go_to(Place) : place(Place, X, Y, Yaw)
  <- !go_to(X, Y, Yaw).

+!go_to(Place)
  <- .concat("there is no belief place(", Place, ", X, Y, Yaw)", Text);
     .fail(error(unknown_place), error_msg(Text), env_failure_reason(unknown_place(Place))).

+!go_to(X, Y, Yaw)
  <- !attempt(drive_there(X, Y, Yaw), 1).

// The one place that knows how this robot drives.
+!drive_there(X, Y, Yaw)
  <- navigate_to(X, Y, Yaw).

/* Attempts: one step, again and again until it succeeds */

+!attempt(Step, _)
  <- !Step.

// The goal was cancelled from outside, so trying again would be wrong.
-!attempt(_, _)[error(Error), error_msg(Text), env_failure_reason(canceled)]
  <- .fail(error(Error), error_msg(Text), env_failure_reason(canceled)).

// It did not work: see what can be done about the reason, and try again.
-!attempt(Step, Number)[env_failure_reason(Reason)] : attempts_allowed(Most) & Number < Most
  <- !recover(Reason);
     !attempt(Step, Number + 1).

// What a program does in its own way may fail without such a reason: then the kind of error is it.
-!attempt(Step, Number)[error(Error)] : attempts_allowed(Most) & Number < Most
  <- !recover(Error);
     !attempt(Step, Number + 1).

// Tried often enough: the reason concerns who wanted the step.
-!attempt(_, _)[error(Error), error_msg(Text), env_failure_reason(Reason)]
  <- .fail(error(Error), error_msg(Text), env_failure_reason(Reason)).

-!attempt(_, _)[error(Error), error_msg(Text)]
  <- .fail(error(Error), error_msg(Text)).

/* Before the next attempt */

// The server is starting, or is gone and may come back.
+!recover(rejected) <- .wait(3000).
+!recover(server_unavailable) <- .wait(3000).
+!recover(server_lost) <- .wait(3000).

// No way was found, or it took too long: forget obstacles that may have gone, and give them time to go.
+!recover(_)
  <- !forget_obstacles;
     .wait(2000).

+!forget_obstacles
  <- clear_costmaps.

// Not every robot can: just as well.
-!forget_obstacles.

/* Patrol */

// From place to place, again and again; or so many rounds.
+!patrol([]).

+!patrol(Places)
  <- !round(Places);
     !patrol(Places).

+!patrol(_, Rounds) : Rounds <= 0.

+!patrol(Places, Rounds)
  <- !round(Places);
     !patrol(Places, Rounds - 1).

+!round([]).

+!round([Place|Rest])
  <- !visit(Place);
     !round(Rest).

// Be there, and do there what the program has a plan `arrived` for: less urgent plans drive no robot meanwhile.
@navigation__visit[needs(wheels)]
+!visit(Place)
  <- !reach(Place, Reached);
     if (Reached == true) {
        !arrived(Place);
     }.

+!reach(Place, true)
  <- !go_to(Place);
     .abolish(unreachable(Place, _)).

// Unknown place: an error in the goal to patrol.
-!reach(_, _)[error(Error), error_msg(Text), env_failure_reason(unknown_place(Place))]
  <- .fail(error(Error), error_msg(Text), env_failure_reason(unknown_place(Place))).

// A place that cannot be reached is left out and known.
-!reach(Place, false)[env_failure_reason(Reason)]
  <- !leave_out(Place, Reason).

-!reach(Place, false)[error(Error)]
  <- !leave_out(Place, Error).

// After a moment: there may be no other place.
+!leave_out(Place, Reason)
  <- .abolish(unreachable(Place, _));
     +unreachable(Place, Reason);
     .wait(1000).

+!arrived(_).

/* Rest: the robot stands as long as there is a reason, whatever less urgent plans want of its wheels */

+!hold(Reason)
  <- !stand_for(Reason);
     .wait(standing).

+!release(Reason)
  <- .abolish(held(Reason)).

+!stand_for(Reason) : standing | .intend(stand_still)
  <- +held(Reason).

+!stand_for(Reason)
  <- +held(Reason);
     !!stand_still.

@navigation__stand[urgency(10), needs(wheels)]
+!stand_still
  <- +standing;
     .wait(not held(_));
     -standing;
     !stand_longer.

+!stand_longer : held(_)
  <- !stand_still.

+!stand_longer.

/* The battery, which is known as battery(Percent, _) or battery(Percent) */

// As long as this goal is pursued, the robot goes to its dock whenever the battery is low.  Plans that need its wheels wait.
+!keep_charged
  <- .wait(battery_low);
     !charge_first;
     !keep_charged.

@navigation__charge[urgency(10), needs(wheels)]
+!charge_first
  <- !dock_and_charge.

// A robot that cannot charge stands, so that its battery lasts until a person has come.
-!charge_first[error(Error), error_msg(Text), env_failure_reason(Reason)]
  <- !stand_for(battery);
     .fail(error(Error), error_msg(Text), env_failure_reason(Reason)).

-!charge_first[error(Error), error_msg(Text)]
  <- !stand_for(battery);
     .fail(error(Error), error_msg(Text)).

// To the dock, wait there until the battery is full, and out again.
+!dock_and_charge
  <- !into_dock;
     !wait_until_charged;
     !out_of_dock.

+!into_dock
  <- !attempt(drive_into_dock, 1).

+!out_of_dock
  <- !attempt(drive_out_of_dock, 1).

// Where Nav2 knows the dock by a name, it finds the way.
+!drive_into_dock : dock_id(Name)
  <- dock_at(Name).

// Others drive to a place in front of it, if the program knows one, and in.
+!drive_into_dock : place(dock, X, Y, Yaw)
  <- !go_to(X, Y, Yaw);
     dock.

+!drive_into_dock
  <- dock.

+!drive_out_of_dock : dock_id(_)
  <- leave_dock.

+!drive_out_of_dock
  <- undock.

// Until the battery is full enough.
+!wait_until_charged : battery_full.

+!wait_until_charged
  <- !get_fuller;
     !wait_until_charged.

// Slow batteries take two minutes for a percent; one that gets no fuller in five stands in no dock.  A goal of its own: a
// program that waits in another way has failures of other kinds.
+!get_fuller : percent_left(Before)
  <- .wait(battery_full | percent_left(Now) & Now > Before, 300000).

+!get_fuller
  <- .wait(percent_left(_), 300000).

-!get_fuller
  <- .fail(error(action_failed), error_msg("the battery has not become fuller for five minutes"),
           env_failure_reason(no_current)).
