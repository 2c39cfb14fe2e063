// The teacher asks questions and counts the correct answers.

question(1, 6 * 7, 42).
question(2, 2 ** 10, 1024).
correct(0).

!ask(1).

+!ask(N) : question(N, Term, _)
  <- .send(pupil, achieve, compute(N, Term)).

+!ask(_) : correct(N)
  <- .print("the lesson is over: ", N, " correct answers");
     .stopMAS.

+answer(N, Value)[source(pupil)] : question(N, _, Value) & correct(C)
  <- .print("correct: ", Value);
     -+correct(C + 1);
     !ask(N + 1).

+answer(N, Value)[source(pupil)]
  <- .print("wrong: ", Value);
     !ask(N + 1).
