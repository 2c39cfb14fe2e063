+go <- .print("arrived"); hit; waitForAll; .print("on 2").
