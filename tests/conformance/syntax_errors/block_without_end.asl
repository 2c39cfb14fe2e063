// A block of a directive must be closed.
!start.
{ begin namespace(m) }
p(1).
+!start <- .print(a); .stopMAS.
