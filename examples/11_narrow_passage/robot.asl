// A robot that brings supplies from a store in the west to a ward in the east, through a passage for one robot at a time.

{ include("$jacaros/artifacts.asl") }

/* What the agent knows; the project file adds the name of its robot, what it brings, its lane, and its starting side */

shelf(west, -3.4).  // x in metres, in the robot's lane: where it loads,
shelf(east, 3.4).   // and where it unloads
front(west, -2.4).  // where it waits for the passage, and where it comes out
front(east, 2.4).
heading(east, 0).  // degrees
heading(west, 180).
opposite(west, east).
opposite(east, west).
loads(3).  // number of loads to bring
brought(0).

colleague(Name) :- .all_names(Names) & .member(Name, Names) & not .my_name(Name).

!start.

+!start : robot(Name)
  <- .concat(Name, "_nav", Nav);
     !use_artifact(Nav, "nav2.yaml", [Name]);
     .wait(pose(_, _, _));
     !errand.

// Sub-goals inherit the urgency of their plan: of all robots that wait for the passage, the medicine goes first.
@medicine[urgency(10)]
+!errand : brings(medicine)
  <- !bring.

+!errand
  <- !bring.

/* From the shelf in the store to the shelf in the ward, and back for the next load */

+!bring : brought(N) & loads(Most) & N >= Most
  <- .print("everything is delivered");
     !end_of_shift.

+!bring : side(west)
  <- !at_shelf;
     !to_the_other_side;
     !bring.

+!bring : side(east)
  <- !at_shelf;
     !count;
     !to_the_other_side;
     !bring.

// A robot that starts in the ward has nothing to unload yet.
+!count : loaded & brings(What) & brought(N)
  <- -loaded;
     -+brought(N + 1);
     .print(What, " ", N + 1, " is in the ward").

+!count.

+!at_shelf : side(Side) & shelf(Side, X) & lane(Y) & opposite(Side, Other) & heading(Other, Yaw)
  <- !go_to(X, Y, Yaw);
     ?handling(Time);
     .wait(Time);
     !load(Side).

+!load(west) <- +loaded.
+!load(east).

+!to_the_other_side
    : side(Side) & front(Side, X) & lane(Y) & opposite(Side, Other) & heading(Other, Yaw)
  <- !go_to(X, Y, Yaw);
     !cross(Other).

/* The passage */

// No artifact has a resource of this name, so it belongs to the run, and all agents share it. The plan acquires it before
// its first step, and releases it when the robot is in front of the passage on the other side, out of the way.
//
// Without `atomic`, the medicine would preempt a robot that is in the passage: the robot would stop there, and the medicine
// would drive into the passage towards it. The resources of an atomic plan cannot be preempted, so urgency decides which
// robot is next, and the robot inside always drives out. Meanwhile, its agent does nothing else.
@cross[atomic, needs(passage)]
+!cross(Other) : front(Other, X) & lane(Y) & heading(Other, Yaw)
  <- !go_to(X, Y, Yaw);
     -+side(Other).

/* The end: a robot that has delivered everything waits for the others */

+!end_of_shift
  <- .broadcast(tell, off_duty);
     .wait(not (colleague(Name) & not off_duty[source(Name)]));
     .stopMAS.

{ include("$jacaros/navigation.asl") }

/* Failures that the library could not recover from */

-!errand[error_msg(Text)]
  <- .print("I need help: ", Text);
     .stopMAS(0, 1).
