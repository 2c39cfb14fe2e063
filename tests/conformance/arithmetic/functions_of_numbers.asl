// Functions of several numbers: spread, middle, and random numbers within their limit.
!t.
+!t <-
  .print(math.std_dev([2,4]), " ", math.std_dev([1,2,6]), " ", math.std_dev([3]));
  .print(math.average([1,2,6]), " ", math.median([5,1,3]), " ", math.median([4,1,3,9]), " ", math.sum([1,2.5]));
  X = math.random(10); if (X >= 0 & X < 10) { .print(within) };
  Y = math.random; if (Y >= 0 & Y < 1) { .print(unit) };
  .print(math.min(3,2), " ", math.max(3,2), " ", math.min([4,7]), " ", math.max([4,7]));
  .print(math.abs(-3), " ", math.floor(-2.5), " ", math.ceil(-2.5), " ", math.round(2.5), " ", math.round(-2.5), " ", math.sqrt(16));
  .stopMAS.
