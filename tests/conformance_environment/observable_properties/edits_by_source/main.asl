!go.
+!go <-
  makeArtifact("d","Dial",[],Id); focus(Id);
  -level(1)[source(percept)]; !show("ground");
  -level(_)[source(percept)]; !show("pattern");
  turn(2); !show("turn");
  +level(9); !show("own"); turn(3); !show("turn");
  stopFocus(Id); !show("stopFocus"); .stopMAS.
+!show(T) <- .findall(l(X,S),level(X)[source(S)],L); .sort(L,SL); .print(T," ",SL).
