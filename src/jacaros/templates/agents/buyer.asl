// The buyer watches the board and buys what it can afford.

money(7).

+offer(What, Price) : money(Money) & Price > 0 & Price <= Money
  <- .print("I take the ", What);
     !order(What).

+offer(What, Price) : Price > 0
  <- .print(Price, " is too much for a ", What).

+!order(What)
  <- .send(seller, achieve, buy(What)).
