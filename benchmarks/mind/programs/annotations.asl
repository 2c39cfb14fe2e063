// Beliefs with annotations are added, and found by them.
!start.
+!start <- !fill($n); !look($n); .stopMAS.
+!fill(0).
+!fill(I) : I > 0 <- +seen(I)[at(I), by(camera)]; !fill(I - 1).
+!look(0).
+!look(I) : seen(I)[by(camera), at(T)] & T == I <- !look(I - 1).
