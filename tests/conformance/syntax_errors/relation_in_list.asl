// A relation inside a list stands in brackets.
!start.
+!start <- .print([(1 < 2)]);
  .print([1 < 2]); .stopMAS.
