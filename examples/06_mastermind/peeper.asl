// Asks for the code itself.  The keeper does not answer.

!peep.

+!peep
  <- .send(keeper, askOne, secret(_), Answer, 3000);
     .print("the keeper says: ", Answer).
