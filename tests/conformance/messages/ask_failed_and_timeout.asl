// An answer that does not unify with the fourth argument fails the step; a time-out is an answer.
p(1).
!start.
+?slow <- .wait(300).
+!start
  <- .send(self, askOne, slow, A, 50); .print(A);
     !ask;
     .stopMAS.
+!ask <- .send(self, askOne, p(_), q(_)); .print(never).
-!ask[error(E), error_msg(_)] <- .print(E).
