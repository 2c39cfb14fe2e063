price(25).
{ include("bidder.asl") }
