// Which actions drop a goal that was suspended before it began.
!start.
+!start <- !!a; .suspend(a); .drop_event(a); .print(s1); .resume(a); .wait(40);
   !!b; .suspend(b); .drop_desire(b); .print(s2); .resume(b); .wait(40);
   !!c; .suspend(c); .drop_intention(c); .print(s3); .resume(c); .wait(40);
   !!d; .suspend(d); .drop_all_events; .print(s4); .resume(d); .wait(40);
   !!e; .suspend(e); .drop_all_desires; .print(s5); .resume(e); .wait(40);
   !!f; .suspend(f); .drop_all_intentions; .print(s6); .resume(f); .wait(40); .stopMAS.
+!a <- .print(a). +!b <- .print(b). +!c <- .print(c). +!d <- .print(d). +!e <- .print(e). +!f <- .print(f).
