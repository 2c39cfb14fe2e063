// A relativised commitment ends when its motive is no longer believed.
wanted.
{ begin rc(home, wanted) }
+!home <- .print(walking); .wait(2000); .print(never).
{ end }
!start.
+!start <- !!get_home; .wait(200); -wanted.
+!get_home <- !home; .print(ended); .stopMAS.
-!get_home <- .print(failed); .stopMAS.
