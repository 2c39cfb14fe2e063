// Handlers among the sub-plans come before those outside, even if they are for goals further down.
!start.
+!start <- !g; .print("after g"); .stopMAS.
+!g <: done <- .print("body"); !sub; .print("after sub"); +done.
{
  +!sub <- .print("sub"); .fail(bad).
  -!g[error(E)] <- .print("inner g handler ", E).
}
-!sub[error(E)] <- .print("outer sub handler ", E).
