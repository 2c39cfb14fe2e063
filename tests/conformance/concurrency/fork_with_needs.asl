// Branches of a fork use what the plan around them needs, and what a branch needs itself is given back when it ends.
!t. !later.
+!t <- !both; .print("both done"); .wait(40); !race; .print("race done").

@b[needs(arm)] +!both <- { !lift(1) } |&| { !lift(2) }; .wait(10); .print("still mine").
@l[needs(arm)] +!lift(N) <- .print("lift ", N); .wait(10 * N); .print("lifted ", N).
+!race <- { !push(1) } ||| { !push(2) }.
@p[needs(base)] +!push(N) <- .print("push ", N); .wait(30); .print("pushed ", N).

+!later <- .wait(5); .print("asks"); !reach; .wait(60); !pull; .stopMAS.
@r[needs(arm)] +!reach <- .print("reached when both are done").
@q[needs(base)] +!pull <- .print("pulled when the race is over").
