!go.
+!go <-
  makeArtifact("t","Typed",[],Id);
  !try(whole(2.5)); !try(whole("2")); !try(whole(2.0));
  !try(flag(yes)); !try(flag(true));
  !try(word(3)); !try(word(hello)); !try(word("hello"));
  !try(numbers([1,a])); !try(numbers([1,2.5]));
  !try(result(5)); !try(result(_));
  .stopMAS.
+!try(Op) <- Op.
-!try(Op)[error(E),env_failure_reason(wrong_op_arguments(_,K))] <- .print(E," ",K).
