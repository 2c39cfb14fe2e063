// An agent that a test creates with !create_mock_agent(Name) to exchange messages with.  It reports when it is idle.

+jag_sleeping : mock_owner(Owner) & .my_name(Me)
  <- .send(Owner, tell, sleeping(Me)).

+jag_awaking : mock_owner(Owner) & .my_name(Me)
  <- .send(Owner, untell, sleeping(Me)).
