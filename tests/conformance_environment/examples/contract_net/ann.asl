price(30).
{ include("bidder.asl") }
