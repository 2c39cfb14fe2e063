// Beliefs with annotations are added, and found by them.
!repeat($times).
+!repeat(0) <- .stopMAS.
+!repeat(R) : R > 0
  <- .print("begin");
     !fill($n);
     !look($n);
     .print("end");
     .abolish(seen(_));
     !repeat(R - 1).
+!fill(0).
+!fill(I) : I > 0 <- +seen(I)[at(I), by(camera)]; !fill(I - 1).
+!look(0).
+!look(I) : seen(I)[by(camera), at(T)] & T == I <- !look(I - 1).
