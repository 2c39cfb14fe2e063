v(0).
+!set(X) <- -+v(X).
+jag_awaking <- +awake.
