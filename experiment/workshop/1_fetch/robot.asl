// The tea from the shelf to the counter.
{ include("../carrier.asl") }

at(tea, shelf).

+!serve <- !bring(tea, counter).
