// A failure in a sub-plan is handled by the bottom goal first, then by goals from the top of the stack down, when only plans outside handle it.
!start.
+!start <- !g(1); .print("after g"); .stopMAS.
+!g(X) <: done(X) <- .print("body"); !sub(X); .print("after sub").
{
  +!sub(X) <- .print("sub ", X); .fail(bad).
}
-!g(X)[error(E)] <- .print("handler outside ", E).
-!start[error(E)] <- .print("start failed ", E); .stopMAS.
