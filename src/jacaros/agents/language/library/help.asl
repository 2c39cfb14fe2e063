// Asking a person for help, with what the robot knows of its trouble.  Include it in a program:
//
//     { include("$jacaros/help.asl") }
//
// and create an artifact of type Operator (see docs/how-to/ask_a_person.md):
//
//     !help(no_current);           // succeeds on `retry`, fails with advised(skip) or advised(stop)
//     !help(no_current, Answer);   // retry, skip or stop
//     !help_or_stop(no_current);   // succeeds on `retry`; otherwise the run ends, with exit status 1
//
// Without an Operator, and without an answer in time, the first two print the text and fail with no_help(Reason).  The
// text has these beliefs, which a program or a library adds, and facts; add rules for more:
//
//     tried("went to the dock three times").            // what was tried
//     would_help(no_current, "wipe the contacts").      // what a person could do
//     help_fact(gripper(Width)) :- gripper(Width).      // what the robot believes

help_fact(battery(Percent, State)) :- battery(Percent, State).
help_fact(battery(Percent)) :- battery(Percent).
help_fact(docked(Docked)) :- docked(Docked).
help_fact(lost) :- lost.
help_fact(unreachable(Place, Reason)) :- unreachable(Place, Reason).

would_help(no_current, "put me into the dock, or wipe its contacts").
would_help(not_charging, "put me into the dock, or wipe its contacts").
would_help(not_docked, "put me into the dock").
would_help(lost, "show me where I am").
would_help(unreachable(_), "clear the way").

+!help(Reason)
  <- !help(Reason, Answer);
     !take_advice(Reason, Answer).

+!help_or_stop(Reason)
  <- !help(Reason).

-!help_or_stop(_)[error(Error), error_msg(Text)]
  <- .stopMAS(0, 1);
     .fail(error(Error), error_msg(Text)).

+!take_advice(_, retry).

+!take_advice(Reason, Answer)
  <- .concat("told to ", Answer, " after ", Reason, Text);
     .fail(error(no_help), error_msg(Text), env_failure_reason(advised(Answer))).

+!help(Reason, Answer)
  <- .findall(What, tried(What), Tried);
     .findall(Fact, help_fact(Fact), Facts);
     .findall(Way, would_help(Reason, Way), Ways);
     ?help_part("I tried: ", Tried, Attempts);
     ?help_part("I believe: ", Facts, Beliefs);
     ?help_part("What would help: ", Ways, Wishes);
     .concat("I am stuck: ", Reason, ". ", Attempts, Beliefs, Wishes, "What shall I do?", Text);
     !ask_for_help(Reason, Text, Answer).

// A sentence of the text; "" for an empty list.
help_part(_, [], "").
help_part(Before, [First|Rest], Sentence) :- help_list(Rest, Others) & .concat(Before, First, Others, ". ", Sentence).
help_list([], "").
help_list([First|Rest], Text) :- help_list(Rest, Others) & .concat(", ", First, Others, Text).

+!ask_for_help(_, Text, Answer)
  <- ask(Text, [retry, skip, stop], Answer).

// The question has been printed: no answer came in time.
-!ask_for_help(Reason, _, _)[env_failure_reason(no_answer(_))]
  <- !end_without_help(Reason).

-!ask_for_help(Reason, Text, _)
  <- .print(Text);
     !end_without_help(Reason).

+!end_without_help(Reason)
  <- .concat("no help with ", Reason, Message);
     .fail(error(no_help), error_msg(Message), env_failure_reason(no_help(Reason))).
