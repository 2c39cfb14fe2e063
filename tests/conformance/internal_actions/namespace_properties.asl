// Namespaces have properties; a property that is not there has the default value, or there is no answer.
!start.
+!start
  <- .namespace_set_prop(family, uri, "x");
     .namespace_get_prop(family, uri, U); .print(U);
     .namespace_get_prop(family, other, D, none); .print(D);
     .namespace_set_prop(family, uri, 3);
     .findall(K, .namespace_get_prop(family, K, 3), L); .print(L);
     .stopMAS.
