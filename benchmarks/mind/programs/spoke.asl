// Joins the others around the hub, and plays the ball back to it.
!join.
+!join <- .my_name(Me); .send(hub, achieve, join(Me)).
+!ball(I) <- .send(hub, achieve, ball(I - 1)).
