// The rules that can prove a literal are those whose head unifies with it; beliefs are not among them.
p(1).
p(X) :- q(X).
p(2) :- true.
q(5).
!start.
+!start
  <- .relevant_rules(p(_), L1); .length(L1, N1); .print(N1);
     .relevant_rules(p(3), L2); .length(L2, N2); .print(N2);
     .relevant_rules(q(_), L3); .print(L3);
     .stopMAS.
