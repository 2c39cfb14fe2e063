// Functions of several numbers take them as arguments or in a list.
!start.
+!start
  <- .print(math.max(1, 5, 3), " ", math.max([1, 5, 3]));
     .print(math.min(4, 2), " ", math.min([4, 2]));
     .print(math.sum(1, 2, 3), " ", math.sum([1, 2, 3]));
     .print(math.average(1, 2), " ", math.average([1, 2, 3, 4]));
     .stopMAS.
