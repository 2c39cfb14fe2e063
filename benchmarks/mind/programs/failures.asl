// Each goal fails two levels down, and its plan for failure takes over.
!start.
+!start <- !loop($n); .stopMAS.
+!loop(0).
+!loop(I) : I > 0 <- !try(I); !loop(I - 1).
+!try(I) <- !sub(I).
+!sub(I) <- .fail.
-!try(I) <- Y = I + 1.
