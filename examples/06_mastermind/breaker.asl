// Breaks the code: every guess fits all answers so far.

tried([]).

!crack.

+!crack : tried(T) & mastermind.codes(T, Guess)
  <- mastermind.ponder(2);
     N = mastermind.left(T);
     .print("I try ", Guess, ", one of ", N);
     .send(keeper, askOne, answer(Guess, _, _), answer(_, Right, Misplaced));
     .print(Right, " right, ", Misplaced, " misplaced");
     !look(Guess, Right, Misplaced).

+!look(Guess, 4, _)
  <- .print("the code is ", Guess);
     .stopMAS.
+!look(Guess, Right, Misplaced) : tried(T)
  <- -+tried([try(Guess, Right, Misplaced)|T]);
     !crack.
