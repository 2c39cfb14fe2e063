// A test goal without a plan fails as a test, also in a sub-plan; the handler outside posts a goal that has plans in and out of the scope.
!start.
+!start <- !g; .print("after g"); .stopMAS.
+!g <: done <- .print("body"); !sub; .print("after sub").
{
  +!sub <- .print("sub"); ?unknown(X).
}
-!g[error(E)] <- .print("g handler ", E); !sub; .print("end of handler").
+!sub <- .print("outer sub").
