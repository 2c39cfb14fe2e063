// `.add_plan` puts a plan before or behind the others, as its third argument says.
!t.
+!t <- !g(1); .add_plan({ +!g(X) <- .print(added, X) }, self, begin); !g(2);
   .add_plan({ +!g(X) <- .print(last, X) }, self, end); !g(3); .stopMAS.
+!g(X) <- .print(old, X).
