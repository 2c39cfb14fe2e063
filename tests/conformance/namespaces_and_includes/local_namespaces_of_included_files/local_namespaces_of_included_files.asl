{ namespace(mine, local) }
{ include("part.asl") }
{ include("other.asl", mine) }
{ include("other.asl", room) }
mine::x(1).
!start.
+!start
  <- .findall(X, mine::x(X), L); .print("own ", L);
     !part;
     !room::go;
     !mine::go.
-!start[error(E)] <- .print(E); .stopMAS.
