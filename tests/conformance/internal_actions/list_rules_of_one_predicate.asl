// list_rules prints each rule with its source, formulae in brackets.
r(X) :- s(X) & not t.
r(X) :- u(X) | X > 2.
!start.
+!start <- .list_rules; .stopMAS.
