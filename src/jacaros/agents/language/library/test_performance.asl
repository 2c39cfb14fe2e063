// Measure how long a goal takes: `!check_performance(goal, 10, Mean)` runs it ten times and returns the mean in nanoseconds
// of the run's clock.  On the virtual clock, only waiting takes time.

@test__check_performance
+!check_performance(Goal, Times, Mean)
  <- .nano_time(Begin);
     for (.range(_, 1, Times)) {
        !Goal
     };
     .nano_time(End);
     Mean = (End - Begin) / Times.

@test__check_performance_print
+!check_performance(Goal, Times)
  <- !check_performance(Goal, Times, Mean);
     .print(Goal, ": ", Mean, " ns").
