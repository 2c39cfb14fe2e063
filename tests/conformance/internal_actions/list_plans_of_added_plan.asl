// list_plans prints the plans of an event as they are written, with their sources.
!start.
+!start <- .add_plan({ @m +!k(X) : a(X) & not b <- .print(X); !j }); .list_plans({+!k(_)}); .stopMAS.
