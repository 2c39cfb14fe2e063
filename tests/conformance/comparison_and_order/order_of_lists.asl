// Lists of different lengths and lists with an open end, compared and sorted.
!t.
+!t <-
  .sort([[1,2],[],f(1),"s",a,2,[1],[0,9,9],[1,2,0],f(0,0),b(9)[x],[[1]],[[0],1]], L); .print(L);
  if ([1,2] < [1,3]) { .print(1) }; if ([2] < [1,1]) { .print(2) }; if ([] < [1]) { .print(3) }; if ([1] < []) { .print(4) };
  if (f(1) < [1]) { .print(5) }; if ([1] < f(1)) { .print(6) }; if ("a" < [1]) { .print(7) }; if (a < [1]) { .print(8) };
  if ([1,2] == [1,2]) { .print(9) }; if ([1,2] \== [2,1]) { .print(10) }; if ([a|[b]] == [a,b]) { .print(11) };
  if ([3,1] <= [3,1]) { .print(12) }; if ([3,1] >= [3]) { .print(13) };
  .stopMAS.
