!start.

+!start <- .wait(pose(_, _, _)); navigate_to(4, 0, 0).
