// The rules that JaCaMo programs expect from $jacamo/templates/common-cartago.asl: joined workspaces, focused artifacts.
// The agent joins and focuses what the project file lists before its first goal, so no plan is needed for that.

// The agent has joined a workspace.
joined(Workspace, Id) :- default::joinedWsp(Id, Workspace, _).

// The agent focuses an artifact.
focused(Workspace, Artifact, Id) :- default::focusing(Id, Artifact, _, _, Workspace, _).
