// What programs of JaCaMo expect of $jacamo/templates/common-cartago.asl: where the agent is, and what it focuses.
// What the project file says of joining and focusing is done before the first goal; no plan is needed for it.

// The agent is in a workspace.
joined(Workspace, Id) :- default::joinedWsp(Id, Workspace, _).

// The agent focuses an artifact.
focused(Workspace, Artifact, Id) :- default::focusing(Id, Artifact, _, _, Workspace, _).
