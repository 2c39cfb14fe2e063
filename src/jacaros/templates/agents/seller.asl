// The seller offers lamps and lowers the price until the buyer takes one.

price(10).

!sell.

+!sell : price(Price) & Price > 0
  <- post("lamp", Price);
     .wait(1000);
     -+price(Price - 2);
     !sell.

+!buy(What)[source(Customer)] : price(Price)
  <- .print("sold a ", What, " for ", Price, " to ", Customer);
     .stopMAS.
