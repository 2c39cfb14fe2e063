// The literals of plans, events and bodies that are arguments stay in the default namespace.
{ begin namespace(m) }
b(1).
+!go <- .add_plan({ +!x : b(Y) <- .print(x(Y)) }); !default::x; .at("now +40", {+!t}); .at("now +80", {+!::t}); .wait(160); P = {!t}; P.
+!t <- .print(in_module).
{ end }
b(5).
+!t <- .print(in_default).
!start.
+!start <- !m::go; .stopMAS.
