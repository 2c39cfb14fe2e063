// Milk and flour from wherever they are to the counter; closets are closed in the end.
{ include("../carrier.asl") }

+!serve
  <- !bring(milk, counter);
     !bring(flour, counter);
     !close(cold_closet);
     !close(dry_closet).
