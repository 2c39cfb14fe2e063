count(0).
+!burst <- .my_name(Me); !!one; !!two; !!three; !!four; !!five; .send(Me, askOne, count(_), X); .print(X).
+!one <- -+count(1).
+!two <- -+count(2).
+!three <- -+count(3).
+!four <- -+count(4).
+!five <- -+count(5); +last(5).
