// One of many agents: counts when it is told to, and says when it is done.
+!work <- !count($n); .send(boss, achieve, finished).
+!count(0).
+!count(I) : I > 0 <- !count(I - 1).
