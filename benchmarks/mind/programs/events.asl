// Each new belief is an event with a plan.
!start.
+!start <- !gen($n); .stopMAS.
+!gen(0).
+!gen(I) : I > 0 <- +b(I); !gen(I - 1).
+b(X) : X > 0 <- Y = X + 1.
