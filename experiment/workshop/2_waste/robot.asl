// The waste of the office into its closet, which is closed in the end.
{ include("../carrier.asl") }

at(can, desk).
at(box, bin).

+!serve
  <- !bring(can, waste_closet);
     !bring(box, waste_closet);
     !close(waste_closet).
