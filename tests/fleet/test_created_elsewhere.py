from test_contract import Counter, on_both


@on_both(["[bob] back", "[bob] 3", "[bob] made in /main/hall"])
async def test_an_agent_creates_a_workspace_at_another_member(two) -> None:
    bob = two.there.add_agent(
        "bob",
        """
        +!go <- createWorkspace("/main/hall", here); .print(back); joinWorkspace("/main/hall");
                makeArtifact(counter, "Counter", [3], Id); focus(Id); ?count(N); .print(N);
                ?joinedWsp(_, hall, Path); .print("made in ", Path).
        """,
    )
    two.here.add_artifact_types(Counter)
    await bob.achieve("go").wait(timeout=9)
    assert [each.path for each in two.here.environment.own()] == ["/main", "/main/hall"]
    assert [each.path for each in two.there.environment.own()] == ["/main"]


@on_both(
    [
        '[bob] unknown_member("her") unknown member `her`; did you mean `here` or `there`?',
        '[bob] workspace_already_present("/main") workspace `/main` already exists',
        '[bob] not_supported("mountWorkspace/3")',
    ]
)
async def test_what_is_impossible_fails_with_its_reason(two) -> None:
    bob = two.there.add_agent(
        "bob",
        """
        +!go <- !try(1); !try(2); !try(3).
        +!try(1) <- createWorkspace(hall, her).
        +!try(2) <- createWorkspace("/main", here).
        +!try(3) <- mountWorkspace("here", "/main", there).
        -!try(3)[env_failure_reason(R)] <- .print(R).
        -!try(_)[env_failure_reason(R), error_msg(M)] <- .print(R, " ", M).
        """,
    )
    await bob.achieve("go").wait(timeout=9)
