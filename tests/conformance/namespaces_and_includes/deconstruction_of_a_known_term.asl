// A term that has a value is taken apart by =.. with a namespace on its left; a plain one gets it.
!g.
+!g <- X = p(1);
   if (ns::X =.. L) { .print(L) } else { .print("no") };
   X =.. M; .print(M);
   .stopMAS.
