+jag_shutting_down(T) <- .print(T); .wait(100); .print(tidied); .wait(700); .print(never).
