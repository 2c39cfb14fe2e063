// Each goal fails two levels down, and its plan for failure takes over.
!repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0 <- .print("begin"); !loop($n); .print("end"); !repeat(R - 1).
+!loop(0).
+!loop(I) : I > 0 <- !try(I); !loop(I - 1).
+!try(I) <- !sub(I).
+!sub(I) <- .fail.
-!try(I) <- Y = I + 1.
