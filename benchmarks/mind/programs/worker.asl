// One of many agents: counts, and says when it is done.
!start.
+!start <- !count($n); .my_name(Me); .send(boss, tell, done(Me)).
+!count(0).
+!count(I) : I > 0 <- !count(I - 1).
