!go.
+!go <- makeArtifact("e","Echo",[],Id); focus(Id); .wait(60);
  for (.member(X,[[],[1,2.5,"t"],[["in"],[[]],[-1,[true,false]]],"", "two words","a \"quoted\" one",[0.0,1.0e3],-0.5])) { !show(X) };
  size([1,[2,3],[]],N); .print(N); sum([1,2.5,-4],S); .print(S); join(["a","b","c"],J); .print(J);
  rows(3,R); .print(R); pair(P); .print(P); P = [K,V]; .print(K," is ",V);
  nothing(Z); if (.ground(Z)) { .print("something") } else { .print("nothing") };
  half("one",H); .print("not reached").
+!show(X) <- echo(X,Y); if (X == Y) { .print("same ",Y) } else { .print(X," became ",Y) }; put(X); ?last(Z); if (X == Z) { .print("held") }.
-!go[error(E)] <- .print("refused ",E); .stopMAS.
