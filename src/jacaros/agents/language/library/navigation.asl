// Plans for robots that go to places, patrol and recharge.  They use the operations of a mapping or an artifact.  Include
// them in a program:
//
//     { include("$jacaros/navigation.asl") }
//
// and describe the world and the robot's limits by beliefs (defaults in parentheses):
//
//     place(kitchen, 2, 2, 90).   // x and y in metres, yaw in degrees
//     attempts(5).                // attempts to reach a place (3)
//     arrives_within(0.03).       // metres from a place at which a patrol has reached it (where a drive ends)
//     visits_within(0.1).         // metres at which it counts as visited if something calls the robot away (never)
//     low_at(30).                 // percent at which the battery is low (20)
//     charged_at(100).            // percent at which it is charged (95)
//     dock_id("dock_1").          // Nav2's name for the robot's dock, if Nav2 does the docking
//
// Plans before the include take precedence, so a program can override every step below.

{ include("$jacaros/help.asl") }

attempts_allowed(N) :- attempts(N).
attempts_allowed(3) :- not attempts(_).

percent_left(Percent) :- reported_charge(Percent) & Percent <= 150.
percent_left(Percent) :- reported_charge(Charge) & Charge > 150 & Percent = Charge / 100.  // the driver counts in percent
reported_charge(Percent) :- battery(Percent, _).
reported_charge(Percent) :- battery(Percent).

// Metres from a place, by pose(X, Y, Yaw) of the mappings of Nav2 and move_base, or the program's own.
from(Place, Metres) :- place(Place, X, Y, _) & pose(NowX, NowY, _) & Metres = math.sqrt((X - NowX) ** 2 + (Y - NowY) ** 2).

beside(Place) :- arrives_within(Metres) & from(Place, Far) & Far > Metres.

battery_low :- percent_left(Percent) & low_at(Least) & Percent <= Least.
battery_low :- percent_left(Percent) & not low_at(_) & Percent <= 20.

battery_full :- percent_left(Percent) & charged_at(Least) & Percent >= Least.
battery_full :- percent_left(Percent) & not charged_at(_) & Percent >= 95.

no_current :- battery(_, discharging).
no_current :- docked(false) & not battery(_, charging) & not battery(_, full).

// Milliseconds for the next percent.  A slow battery takes two minutes for the first one; a fast one falls by then if it is
// not charging.
patience(Ms) :- slowest_percent(Slowest) & Ms = 10000 + 4 * Slowest.
patience(300000) :- not slowest_percent(_).

/* Going to a place */

// Go to a place by its name, or to a pose in the map (metres and degrees).
+!go_to(Place) : place(Place, X, Y, Yaw)
  <- !go_to(X, Y, Yaw).

+!go_to(Place)
  <- .concat("unknown place `", Place, "`: no belief place(", Place, ", X, Y, Yaw)", Text);
     .fail(error(unknown_place), error_msg(Text), env_failure_reason(unknown_place(Place))).

+!go_to(X, Y, Yaw)
  <- !attempt(drive_there(X, Y, Yaw), 1).

// The only step that depends on how this robot drives.
+!drive_there(X, Y, Yaw)
  <- navigate_to(X, Y, Yaw).

/* Attempts: run a step until it succeeds */

+!attempt(Step, _)
  <- !Step.

// The goal was cancelled from outside: do not retry.
-!attempt(_, _)[error(Error), error_msg(Text), env_failure_reason(canceled)]
  <- .fail(error(Error), error_msg(Text), env_failure_reason(canceled)).

// The dock gives no current: dock anew, but do not try until the battery is empty.
-!attempt(wait_until_charged, Number) : Number < 3 & not percent_left(0)
  <- .print("charging failed: no current; I dock again");
     !back_out;
     !into_dock;
     !attempt(wait_until_charged, Number + 1).

// The step failed: recover from the reason, and retry.
-!attempt(Step, Number)[env_failure_reason(Reason)] : Step \== wait_until_charged & attempts_allowed(Most) & Number < Most & not percent_left(0)
  <- !recover(Reason);
     !attempt(Step, Number + 1).

// A program's own step may fail without such a reason: recover from the kind of error instead.
-!attempt(Step, Number)[error(Error)] : Step \== wait_until_charged & attempts_allowed(Most) & Number < Most & not percent_left(0)
  <- !recover(Error);
     !attempt(Step, Number + 1).

// No attempts left: pass the failure to the goal that posted this one.
-!attempt(_, _)[error(Error), error_msg(Text), env_failure_reason(Reason)]
  <- .fail(error(Error), error_msg(Text), env_failure_reason(Reason)).

-!attempt(_, _)[error(Error), error_msg(Text)]
  <- .fail(error(Error), error_msg(Text)).

/* Before the next attempt */

// The server is starting, or has stopped and may come back.
+!recover(rejected) <- .wait(3000).
+!recover(server_unavailable) <- .wait(3000).
+!recover(server_lost) <- .wait(3000).

// The dock gives no current: leave it, and dock again.
+!recover(not_charging) <- !back_out.

+!back_out : not docked(false)
  <- !drive_out_of_dock.

+!back_out.

// It is not in a dock.
-!back_out.

// No path was found, or it took too long: forget obstacles that may have moved, and give them time to move.
+!recover(_)
  <- !forget_obstacles;
     .wait(2000).

+!forget_obstacles
  <- clear_costmaps.

// Not every robot has this operation: ignore the failure.
-!forget_obstacles.

/* Patrol */

// Visit the places in turn, without end or for a number of rounds.
+!patrol([]).

+!patrol(Places)
  <- !round(Places);
     !patrol(Places).

+!patrol(_, Rounds) : Rounds <= 0 & left_out(Place, Reason)
  <- .abolish(left_out(_, _));
     .concat("place ", Place, " was left out", Text);
     .fail(error(left_out), error_msg(Text), env_failure_reason(Reason)).

+!patrol(_, Rounds) : Rounds <= 0.

+!patrol(Places, Rounds)
  <- !round(Places);
     !come_back(Places);
     !patrol(Places, Rounds - 1).

// After the others, a place may be within reach.
+!come_back(Places)
  <- .findall(Place, .member(Place, Places) & unreachable(Place, _), Missed);
     !round(Missed);
     for (.member(Place, Missed) & unreachable(Place, Reason)) {
        +left_out(Place, Reason)
     }.

+!round([]).

+!round([Place|Rest])
  <- !visit(Place);
     !round(Rest).

// Go to a place and run the program's plan `arrived` there.  Meanwhile, less urgent plans cannot use the wheels.
@navigation__visit[needs(wheels)]
+!visit(Place)
  <- !reach(Place, Reached);
     if (Reached == true) {
        !arrived(Place);
     }.

+!reach(Place, true)
  <- !arrive_at(Place, tries(1));
     .abolish(visited(_));
     .abolish(unreachable(Place, _)).

// Late wheels roll on, and the estimate of the pose may still change: go there again.
+!arrive_at(Place, tries(Number))
  <- !go_to(Place);
     .wait(not beside(Place), 1000, _);
     !found_at(Place, tries(Number)).

+!found_at(Place, tries(Number)) : beside(Place) & attempts_allowed(Most) & Number < Most
  <- !arrive_at(Place, tries(Number + 1)).

+!found_at(Place, _) : beside(Place)
  <- .fail(error(action_failed), error_msg("the robot stands beside the place"), env_failure_reason(not_there)).

+!found_at(_, _).

// What calls the robot away just before a place waits until it has been there; the visit then ends without the rest of the drive.
nearly_there :- visits_within(Metres) & .desire(reach(Place, _)) & from(Place, Far) & Far > 0.7 * Metres & Far <= 2 * Metres.

+pose(_, _, _) : visits_within(Metres) & not lost & .desire(reach(Place, _)) & from(Place, Far) & Far <= Metres
  <- -+visited(Place).

+visited(_) : .intend(charge_now) | lifted
  <- !end_visit.

+!end_visit : visited(Place)
  <- .abolish(visited(_));
     .succeed_goal(visit(Place));
     !arrived(Place).

+!end_visit.

// An unknown place is an error in the patrol goal.
-!reach(_, _)[error(Error), error_msg(Text), env_failure_reason(unknown_place(Place))]
  <- .fail(error(Error), error_msg(Text), env_failure_reason(unknown_place(Place))).

// Skip a place that cannot be reached, and remember it as unreachable(Place, Reason).
-!reach(Place, false)[env_failure_reason(Reason)]
  <- !leave_out(Place, Reason).

-!reach(Place, false)[error(Error)]
  <- !leave_out(Place, Error).

// Say so, and wait for a moment: there may be no other place to visit.
+!leave_out(Place, Reason)
  <- .abolish(unreachable(Place, _));
     +unreachable(Place, Reason);
     .print("I need help, or come back later: place ", Place, " is out of reach, ", Reason);
     .wait(1000).

+!arrived(_).

/* Holding: the robot stands still while there is a reason to, and less urgent plans cannot use its wheels */

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

/* The battery: battery(Percent, _) or battery(Percent) */

// While this goal is active, the robot goes to its dock whenever the battery is low.  Plans that need its wheels wait.
+!keep_charged
  <- .wait(battery_low);
     !charge_first;
     !keep_charged.

+!charge_first
  <- .wait(not nearly_there, 5000, _);
     !charge_now.

@navigation__charge[urgency(10), needs(wheels)]
+!charge_now
  <- !end_visit;
     !dock_and_charge.

// A robot that cannot charge stands still, so that its battery lasts until a person comes.
-!charge_first[error(Error), error_msg(Text), env_failure_reason(Reason)]
  <- !stand_for(battery);
     !advice(Reason, Answer);
     if (Answer \== retry) {
        .fail(error(Error), error_msg(Text), env_failure_reason(Reason))
     };
     !charge_again.

-!charge_first[error(Error), error_msg(Text)]
  <- !stand_for(battery);
     !advice(Error, Answer);
     if (Answer \== retry) {
        .fail(error(Error), error_msg(Text))
     };
     !charge_again.

+!advice(Reason, Answer)
  <- !help(Reason, Answer).

// No answer comes.
-!advice(_, stop).

+!charge_again
  <- !release(battery);
     !charge_first.

// Drive into the dock, wait until the battery is full, and drive out.
+!dock_and_charge
  <- !into_dock;
     !attempt(wait_until_charged, 1);
     !out_of_dock.

// A person has put it there.
+!into_dock : docked(true) & not no_current.

// Its dock has given no current; a robot in a dock refuses to dock.
+!into_dock : docked(true)
  <- !back_out;
     !attempt(drive_into_dock, 1).

+!into_dock
  <- !attempt(drive_into_dock, 1).

+!out_of_dock
  <- !attempt(drive_out_of_dock, 1).

// If Nav2 knows the dock by name, it drives there.
+!drive_into_dock : dock_id(Name)
  <- dock_at(Name).

// Otherwise, drive to the place in front of the dock, if the program has one, and then into the dock.
+!drive_into_dock : place(dock, X, Y, Yaw)
  <- !go_to(X, Y, Yaw);
     dock.

+!drive_into_dock
  <- dock.

+!drive_out_of_dock : dock_id(_)
  <- leave_dock.

+!drive_out_of_dock
  <- undock.

// Wait until the battery is full, percent by percent.  This fails as soon as percepts say that no current flows.
+!wait_until_charged : battery_full.

+!wait_until_charged
  <- .nano_time(Begin);
     !gain_a_percent;
     .nano_time(End);
     !learn_rate((End - Begin) / 1000000);
     !wait_until_charged.

+!gain_a_percent : percent_left(Before) & patience(Ms)
  <- !get_fuller(Before)[within(Ms)].

// No message of the battery has come yet.
+!gain_a_percent
  <- .wait(percent_left(_), 10000).

-!gain_a_percent
  <- .abolish(fallen);
     .fail(error(action_failed), error_msg("the battery is not charging"), env_failure_reason(no_current)).

// A sign that no current flows counts when it has lasted: sensors lag, and contacts flicker.
+!get_fuller(Before)
  <- .wait(battery_full | no_current | percent_left(Now) & (Now > Before | Now < Before - 1));
     .wait(not no_current, 5000);
     !fuller_than(Before).

+!fuller_than(Before) : battery_full | percent_left(Now) & Now > Before.

+!fuller_than(Before) : percent_left(Now) & Now >= Before - 1
  <- !get_fuller(Before).

// The level has fallen.  A gauge may correct itself once, if the battery reports that it charges; a second fall is too much.
+!fuller_than(Before) : battery(Now, charging) & not fallen
  <- +fallen;
     !get_fuller(Now);
     -fallen.

// How long the next percent may take: much longer than the slowest so far, because a nearly full battery charges slowly.
+!learn_rate(Ms) : slowest_percent(Slowest) & Slowest >= Ms.

+!learn_rate(Ms)
  <- -+slowest_percent(Ms).

/* Doubt about one's place: lost, of the mappings of Nav2 and move_base, or the program's own */

// The robot stops what it does, searches, and continues.  More urgent than all that drives: other plans that need the wheels wait.
@navigation__lost[urgency(20), needs(wheels)]
+lost
  <- .abolish(visited(_));
     !find_place;
     !return_to_work.

// A person has shown the robot its place, after it had given up.
@navigation__found[urgency(20), needs(wheels)]
-lost : held(lost)
  <- !return_to_work;
     !release(lost).

+!find_place
  <- !begin_search;
     !search_place(1).

// The robot stands still, and asks a person.
-!find_place
  <- !stand_for(lost);
     !advice(lost, Answer);
     if (Answer \== retry) {
        .fail(error(lost), error_msg("the robot does not find its place on the map"), env_failure_reason(lost))
     };
     !release(lost);
     !find_place.

+!begin_search
  <- relocalise.

// Some robots search without being asked.
-!begin_search.

+!search_place(_) : not lost.

+!search_place(Number) : Number <= 4
  <- !turn_on_the_spot(360);
     !drive_to_open_ground;
     !search_place(Number + 1).

+!turn_on_the_spot(Degrees)
  <- spin(Degrees).

// Without Nav2, by the operation of a TurtleBot.
-!turn_on_the_spot(Degrees)
  <- drive(0, 45, Degrees / 45).

+!drive_to_open_ground : not lost.

+!drive_to_open_ground
  <- drive_on_heading(0.7, 0.2).

// Something is in the way: try another direction.
-!drive_to_open_ground
  <- !turn_on_the_spot(130).

// An interrupted drive is repeated in any case; work that has begun at a place continues there.
+!return_to_work : .desire(arrived(Place))
  <- !go_to(Place).

// The leg of a robot that drives leg by leg began where it no longer is: it ends, and the next one begins here.
+!return_to_work
  <- .succeed_goal(drive_leg).

// The robot is lifted: it stands until its localisation has had the time to doubt.
+hazard(wheel_drop, _) <- +lifted.
+wheel_drop(_, dropped) <- +lifted.

@navigation__lifted[urgency(20), needs(wheels)]
+lifted
  <- .wait(lost, 3000, _);
     -lifted;
     !end_visit;
     !work_here.

// The search returns to work.
+!work_here : lost.

+!work_here
  <- !return_to_work.
