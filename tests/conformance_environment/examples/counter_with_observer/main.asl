!go.
+!go <-
  makeArtifact("c0","Counter",[5],Id); .wait(200);
  !count(3);
  ?not_focused; .wait(100); .send(bob,achieve,tell); .wait(100); .stopMAS.
+!count(0).
+!count(N) <- inc; .wait(30); !count(N-1).
+?not_focused <- .count(count(_),N); .print("believes ",N," counts").
+count(N) <- .print("never seen ",N).
