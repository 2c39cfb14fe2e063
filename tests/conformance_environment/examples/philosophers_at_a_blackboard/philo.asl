+!dine(L,R,0) : .my_name(Me) <- .print("full"); .send(main,tell,done(Me)).
+!dine(L,R,N) <- in(ticket); in(fork,L); in(fork,R); .wait(10); .print("eats ",N); out(fork,L); out(fork,R); out(ticket); !dine(L,R,N-1).
