+!learn <- +known(42).
+jag_awaking <- +awake.
