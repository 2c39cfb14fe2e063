price(20).
{ include("bidder.asl") }
