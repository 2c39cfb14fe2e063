// One of many agents: counts on request, and reports when it has finished.
+!work <- !count($n); .send(boss, achieve, finished).
+!count(0).
+!count(I) : I > 0 <- !count(I - 1).
