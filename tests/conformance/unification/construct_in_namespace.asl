// The relation =.. makes a literal of another namespace only for a variable that is written in it.
!start.
+!start
  <- !plain; !named; !open; .stopMAS.
+!plain <- X =.. [ns, q, [1], []]; .print(never).
-!plain[error(E)] <- .print(E).
+!named <- ns::X =.. [ns, q, [1], []]; .print(made).
+!open <- N::X =.. [ns, q, [1], []]; .print(N).
