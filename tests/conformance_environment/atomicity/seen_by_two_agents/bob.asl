!watch.
+!watch <- .wait(60); lookupArtifact("t",Id); focus(Id).
+!tell <- .findall(c(X,Y),from(X) & to(Y),L); .print(L).
+from(X) : to(Y) <- .print("from ",X," while to is ",Y).
+to(Y) : from(X) <- .print("to ",Y," while from is ",X).
