// Counts who is done: adding to a number, as a look at all of them each time would be what is measured.
left($k).
+done(_) : left(1) <- .stopMAS.
+done(_) : left(N) <- -+left(N - 1).
