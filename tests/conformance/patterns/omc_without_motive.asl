// An open-minded commitment ends when the motive is no longer believed.
wanted.
{ begin omc(home, lost, wanted) }
+!home <- .print(walking); .wait(2000); .print(never).
{ end }
!start.
+!start <- !!get_home; .wait(200); -wanted.
+!get_home <- !home; .print(ended); .stopMAS.
-!get_home <- .print(failed); .stopMAS.
