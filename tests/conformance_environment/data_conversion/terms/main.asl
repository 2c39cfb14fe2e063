!go.
+!go <-
  makeArtifact("e","Echo");
  for (.member(X,["text","",true,false,[],[1,"a",[b,true]],kitchen,'Two words',at(1,"x",[y]),~lost,~at(2),lab::at(3)])) { !show(X) };
  words(W,T,F,L,N); if (.string(W)) { .print(W," is a string") }; .print(T," ",F," ",L); if (not .ground(N)) { .print("nothing stays unbound") };
  if (T) { .print("a condition") };
  map(M); .map.get(M,"a",V); .print(V); thing(R); is(R,Y); .print(Y); +kept(R); ?kept(R2); is(R2,Y2); .print(Y2);
  fill([A,p(B)]); .print(A," ",B);
  .stopMAS.
+!show(X) <- echo(X,Y); kind(X,K); if (X == Y) { .print(X," ",K," the same") } else { .print(X," ",K," ",Y) }.
