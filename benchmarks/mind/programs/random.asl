// Random numbers, and random elements of a list.
!repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0 <- .print("begin"); !loop($n); .print("end"); !repeat(R - 1).
+!loop(0).
+!loop(I) : I > 0
  <- .random(X); Y = math.floor(math.random(6)) + 1; .random([red, green, blue], C); !loop(I - 1).
