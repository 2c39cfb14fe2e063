// Knows the code: its class, Keeper of mastermind.py, believes secret(Code) from the beginning.

+?answer(Guess, Right, Misplaced) : secret(Code)
  <- mastermind.score(Code, Guess, Right, Misplaced).
