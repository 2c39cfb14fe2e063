// A condition of a plan: variables that the plan has not bound are free in every check, those of its trigger are not.
battery(80). at(hall). at(kitchen).
!t.
+!t <- !!drain; !clean(kitchen); .print("goes on"); !always; .stopMAS.

@c[while(battery(B) & B > 20 & at(Room)), cleanup(park(Room))]
+!clean(Room) <- .print("cleaning ", Room); .wait(60000); .print(never).
-!clean(Room)[error(E)] <- ?battery(B); .print("stopped cleaning the ", Room, ": ", E, " at ", B).
+!park(Room) <- .print("leaving the ", Room).

@a[while(not at(attic) & battery(B) & not B < 5)]
+!always <- -+battery(7); .wait(20); ?battery(B); .print("still at ", B).

+!drain <- for (.member(B, [70, 60, 20, 10])) { .wait(20); -+battery(B); .print("battery ", B) }.
