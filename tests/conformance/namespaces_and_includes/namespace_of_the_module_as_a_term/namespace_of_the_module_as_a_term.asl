{ include("room.asl", hall) }
{ include("room.asl", kitchen) }
{ include("room.asl") }
here(this_ns)[in(this_ns)].
!start.
+!start <- !hall::show; !kitchen::show; !show; ?here(X)[in(Y)]; .print(X, " ", Y); X == default; .stopMAS.
