!go.
+!go <-
  createWorkspace("w"); joinWorkspace("w",_); makeArtifact("Front Dial-1","Dial",[],Id); makeArtifact("plain","Dial",[],_);
  left::focus(Id); right::focus(Id); .wait(20); !show("focused");
  left::turn(2); .wait(20); !show("turned");
  left::stopFocus(Id); .wait(20); !show("left stopped");
  right::turn(3); .wait(20); !show("turned");
  ?right::level(_)[artifact_name(N)]; .print(N); if (.atom(N)) { .print(atom) };
  right::stopFocus(Id); .wait(20); !show("right stopped"); .stopMAS.
+!show(T) <- .findall(X,left::level(X),L); .findall(X,right::level(X),R); .findall(X,level(X),D); .print(T," ",L," ",R," ",D).
+left::turned(X) <- .print("left turned ",X).
+right::turned(X) <- .print("right turned ",X).
+turned(X) <- .print("turned ",X).
