!look.
+!look <- focusWhenAvailable("tasks"); .print("looks").
+task(What,Board) : price(P) & .my_name(Me) <- .print(What," for ",P); focusWhenAvailable(Board); bid(Me,P,N)[artifact_name(Board)]; +mine(N); ?winner(W); !check(W,N).
+winner(W) : mine(N) <- !check(W,N).
+!check(none,_).
+!check(N,N) <- .print("wins").
+!check(W,N) <- .print("loses").
