// The residents of the house: they leave parcels, and end the run when all have arrived.

parcels(14).

!live.

+!live
  <- order(kitchen, hallway);
     order(bathroom, living_room);
     order(hallway, kitchen);
     .wait(20000);  // milliseconds
     order(living_room, bathroom);
     order(kitchen, bathroom);
     .wait(25000);
     order(bathroom, kitchen);
     order(hallway, living_room);
     .wait(60000);
     order(living_room, hallway);
     order(kitchen, living_room);
     order(hallway, bathroom);
     .wait(20000);
     order(bathroom, hallway);
     order(bathroom, kitchen);
     .wait(30000);
     order(kitchen, living_room);
     order(hallway, bathroom).

+delivered(Count) : parcels(Count)
  <- .print("all ", Count, " parcels have arrived");
     .stopMAS.
