// All of that in one run, for which one charge of the battery is too little.
{ include("../carrier.asl") }

at(can, desk).
at(box, bin).

+!serve
  <- !bring(milk, counter);
     !bring(flour, counter);
     !close(cold_closet);
     !close(dry_closet);
     !bring(can, waste_closet);
     !bring(box, waste_closet);
     !close(waste_closet).
