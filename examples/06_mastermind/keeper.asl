// Knows the code: its class, Keeper in mastermind.py, adds the belief secret(Code) at the start.

+?answer(Guess, Right, Misplaced) : secret(Code)
  <- mastermind.score(Code, Guess, Right, Misplaced).
