// Two colons without a name, and this_ns, mean the namespace of the module, also in arguments.
{ begin namespace(m) }
p(2).
+!go <- ?p(A); ?::p(B); ?this_ns::p(C); .print(A,B,C); .print(p(1)," ",::p(1)," ",this_ns::p(1)); .findall(X,::p(X),L); .print(L); !::sub.
+!sub <- .print(sub).
{ end }
p(7).
!start.
+!start <- ?::p(B); .print(B); !m::go; .stopMAS.
+!sub <- .print(bad).
