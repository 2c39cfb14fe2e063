// A plan for a declarative goal that does not bring about its belief fails, and so does a handler that does not.
{ begin dg(at(X)) }
+!at(X) : X > 5 <- .print(far(X)); +at(X).
+!at(X) <- .print(near(X)).
-!at(X) <- .print(handler(X)).
+!other <- .print(other).
{ end }
!start.
+!start <- !at(7); .print(one); !other; !at(2); .print(bad).
-!start[error(E)] <- .print(E); .stopMAS.
