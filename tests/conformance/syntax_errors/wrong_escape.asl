// A string holds only the escapes of the language.
!start.
+!start <- .print("a\"b");
  .print("a\d"); .stopMAS.
