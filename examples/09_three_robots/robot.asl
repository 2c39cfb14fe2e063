// A robot that watches some places of a storehouse, and those of another robot while that one charges.

{ include("$jacaros/artifacts.asl") }

/* What the agent knows; the project file adds the name of its robot, the places to watch, and the dock */

place(north_west, -1.5, 2.2, 0).  // x and y in metres, yaw in degrees
place(north_east, 3.2, 2.2, 180).
place(middle_west, -1.5, 0, 0).
place(middle_east, 3.2, 0, 180).
place(south_west, -1.5, -2.2, 0).
place(south_east, 3.2, -2.2, 180).
shift(2).  // number of recharges in a shift
recharges(0).

colleague(Name) :- .all_names(Names) & .member(Name, Names) & not .my_name(Name).

// A robot helps only if its own battery is well charged.
can_help(Percent) :- percent_left(Percent) & Percent > 40 & not charging & not off_duty.

!start.

+!start
  <- !use_robot;
     .wait(pose(_, _, _));
     !!keep_charged;
     !!watch.

// One parameter, the robot's name, is the prefix of all topics, actions and frames.
+!use_robot : robot(Name)
  <- .concat(Name, "_nav", Nav);
     .concat(Name, "_base", Base);
     !use_artifact(Nav, "nav2.yaml", [Name]);
     !use_artifact(Base, "turtlebot4.yaml", [Name]).

// In a process of its own, the robot can get the prefix from the command line: jacaros run robot.asl --namespace robot_1
+!use_robot
  <- !use_artifact(nav, "nav2.yaml", []);
     !use_artifact(base, "turtlebot4.yaml", []).

/* Watching: the places may change from round to round */

+!watch : not watched(_)
  <- .wait(watched(_));
     !watch.

+!watch
  <- .findall(Place, watched(Place), Places);
     !round(Places);
     !watch.

+!arrived(Place) : watched(Place)[source(Owner)] & Owner \== self & not watched(Place)[source(self)]
  <- .print("at ", Place, " for ", Owner).

+!arrived(_).

/* Charging: the steps of the library, with messages to the others before and after */

+!dock_and_charge
  <- +charging;
     !hand_over;
     !into_dock;
     !attempt(wait_until_charged, 1);
     -charging;
     !count;
     !end_of_shift;
     !out_of_dock;
     !take_back.

+!count : recharges(N)
  <- -+recharges(N + 1).

// Give the places of this robot to the colleague with the fullest battery: `tell` adds them to its beliefs.
+!hand_over
  <- for (colleague(Name)) {
        .send(Name, askOne, can_help(_), Answer, 2000);
        if (can_help(Percent) = Answer) {  // not `false` or `timeout`
           +offer(Percent, Name)
        }
     };
     .findall(offer(Percent, Name), offer(Percent, Name), Offers);
     .abolish(offer(_, _));
     !choose(Offers).

+!choose([])
  <- .print("battery low, and no robot has time for my places").

+!choose(Offers)
  <- .max(Offers, offer(_, Helper));
     .print("battery low, ", Helper, " has my places");
     +helper(Helper);
     for (watched(Place)[source(self)]) {
        .send(Helper, tell, watched(Place))
     }.

+!take_back : helper(Helper)
  <- -helper(Helper);
     .print("battery full, thank you, ", Helper);
     for (watched(Place)[source(self)]) {
        .send(Helper, untell, watched(Place))
     }.

+!take_back
  <- .print("battery full").

/* The end of the shift: wait in the dock until the shifts of all robots have ended */

+!end_of_shift : shift(Most) & recharges(N) & N >= Most
  <- .print("my shift is over");
     !sign_off.

+!end_of_shift.

+!sign_off
  <- +off_duty;
     .drop_desire(watch);
     .broadcast(tell, off_duty);
     .wait(not (colleague(Name) & not off_duty[source(Name)]));
     ?status(Status);
     .stopMAS(0, Status).

// The exit status reports that a robot is in need, or has left out a place.
status(1) :- in_need | unreachable(_, _).
status(0) :- not in_need & not unreachable(_, _).

{ include("$jacaros/navigation.asl") }

/* A robot that cannot charge, and that gets no help: the others keep its places */

-!keep_charged[error_msg(Text)]
  <- .print("I need help: ", Text);
     +in_need;
     .broadcast(tell, in_need);
     !sign_off.
