// A maintenance goal may name any other pattern for its plans, with the arguments of that pattern.
wanted.
{ begin mg(charged, rc(charged, wanted)) }
+!charged <- .print(charging); .wait(80).
{ end }
!start.
+!start <- .wait(40); --charged; .wait(200); -wanted; .wait(200); if (not charged) { .print(given_up) }; .stopMAS.
