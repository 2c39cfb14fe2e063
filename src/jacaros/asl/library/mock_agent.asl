// An agent that a test makes by !create_mock_agent(Name), to talk to.  It tells the test's agent when it has nothing to do.

+jag_sleeping : mock_owner(Owner) & .my_name(Me)
  <- .send(Owner, tell, sleeping(Me)).

+jag_awaking : mock_owner(Owner) & .my_name(Me)
  <- .send(Owner, untell, sleeping(Me)).
