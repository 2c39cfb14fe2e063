// A maintenance goal is pursued again until it holds when its plan fails.
{ begin mg(charged) }
+!charged : not tried <- .print(first); +tried; .fail.
+!charged <- .print(second); +charged.
{ end }
!start.
+!start <- .wait(40); -charged; .wait(80); if (charged) { .print(restored) }; .stopMAS.
