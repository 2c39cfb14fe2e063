// With nested sub-plans, the scopes are searched for handlers from the inside out.
!start.
+!start <- !top; .print("after top"); .stopMAS.
+!top <- !mid; .print("after mid").
{
  +!mid <: m <- !low; .print("after low").
  {
     +!low <- .print("low"); .fail(e).
  }
  -!mid <- .print("mid handler in top").
}
-!low <- .print("low handler in root").
-!top <- .print("top handler").
