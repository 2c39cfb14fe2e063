// What the robot knows of the building: where to stand, in metres, where to look, in degrees, and what is behind which door.

place(counter, 0, 2.3, 90).
place(shelf, -3.45, 0.6, 180).
place(desk, 3.45, 2.2, 0).
place(bin, 3.45, 0.8, 0).
place(cold_closet, -3.5, 2.3, 90).
place(dry_closet, -2, 2.3, 90).
place(waste_closet, -3.3, -1.5, 180).
place(dock, 2.6, -1.5, 0).
place(front(cold_closet), -3.5, 1.7, 90).
place(front(dry_closet), -2, 1.7, 90).
place(front(waste_closet), -2.7, -1.5, 180).
place(front(waste_room), -0.9, -1.5, 180).
place(front(charging_room), 0.9, -1.5, 0).

behind(cold_closet, cold_closet).
behind(dry_closet, dry_closet).
behind(waste_closet, waste_closet).
behind(front(waste_closet), waste_room).
behind(dock, charging_room).

may_hold(cold_closet).  // closets in which things are looked for
may_hold(dry_closet).
