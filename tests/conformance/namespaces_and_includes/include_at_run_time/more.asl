colour(red).
+!hello(X) <- .print(hello(X)).
