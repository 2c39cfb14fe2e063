// The pupil computes what it is asked, and answers.

+!compute(N, Term)[source(Teacher)]
  <- Value = Term;
     .send(Teacher, tell, answer(N, Value)).
