"""Internal actions that reach beyond one mind: files, copies of agents, the directory, the end of agents."""

from collections.abc import Callable
from pathlib import Path

import pytest

from jacaros.testing import RunResult, run_project

Ran = Callable[..., RunResult]


def test_the_directory_knows_who_provides_what(ran: Ran) -> None:
    result = ran(
        m_mas2j="MAS m { agents: a; b; }",
        a_asl="""!go. +!go <- .df_register("sell(book)"); .df_register(paint, "art"); .wait(50);
            .df_search("sell(book)", L); .print(L); .df_search(paint, art, P); .print(P);
            .df_deregister(paint); .df_search("paint", E); .print(E); .all_names(N); .print(N).""",
        b_asl=""" !go. +!go <- .wait(10); .df_register("sell(book)").""",
    )
    assert result.lines == ["[a] [a,b]", "[a] [a]", "[a] []", "[a] [a,b,df]"]


def test_subscribers_are_notified_of_present_and_later_providers(ran: Ran) -> None:
    result = ran(
        m_mas2j="MAS m { agents: a; b; c; }",
        a_asl="""!go. +!go <- .wait(10); .df_subscribe("sell"); .df_subscribe("sell").
            +provider(A, S)[source(W)] <- .print(A, " ", S, " ", W).""",
        b_asl='!go. +!go <- .df_register("sell").',
        c_asl='!go. +!go <- .wait(20); .df_register("sell"); .df_register("buy").',
    )
    assert result.lines == ["[a] b sell df", "[a] c sell df"]


def test_the_directory_can_be_asked(ran: Ran) -> None:
    program = '!go. +!go <- .df_register("sell"); .send(df, askOne, provider(A, "sell"), R); .print(R).'
    assert ran(program).lines == ['[a] provider(a,"sell")[source(df)]']


def test_files_are_listed_with_those_of_inner_folders(tmp_path: Path, ran: Ran) -> None:
    (tmp_path / "data" / "inner").mkdir(parents=True)
    for name in ("b.txt", "a.asl", "inner/c.asl"):
        (tmp_path / "data" / name).write_text("", encoding="utf-8")
    result = ran("""!go. +!go <- .list_files("data", L); .print(L); .list_files("data", ".*[.]asl", R); .print(R);
            !failing({ .list_files("nowhere", _) }); !failing({ .list_files(data, _) });
            !failing({ .list_files("data", "[", _) }).
            +!failing(B) <- B.
            -!failing(_)[error(E)] <- .print(E).""")
    assert result.lines == [
        '[a] ["data/a.asl","data/b.txt","data/inner/c.asl"]',
        '[a] ["data/a.asl","data/inner/c.asl"]',
        "[a] internal_action",
        "[a] wrong_arguments",
        "[a] wrong_arguments",
    ]


def test_a_saved_agent_can_be_run(tmp_path: Path, ran: Ran) -> None:
    first = ran("""{ register_function("my.twice", 1, "twice") }
            twice(X, Y) :- Y = X * 2.
            p(1)[source(bob)]. p(2). ~q("x"). open(_).
            @known[atomic] +!go(N) : p(N) & not r <- X = my.twice(N); +seen(X); .print(X); ?seen(X).
            !begin. +!begin <- +p(3); .add_plan("+!more <- .print(more)."); .save_agent("b.asl", [go(2), more]).""")
    assert first.errors == []
    again = run_project(tmp_path / "b.asl", until_idle=True)
    assert sorted(again.lines) == ["[b] 4", "[b] more"]
    text = (tmp_path / "b.asl").read_text(encoding="utf-8")
    assert "p(1)[source(bob)]." in text
    assert "p(3).\np(1)" in text


def test_a_program_is_included_at_run_time(ran: Ran) -> None:
    result = ran(
        a_asl="""!go. +!go <- .include("other.asl"); .include("other.asl"); !hello; .include("other.asl", ns);
            ?ns::q(X); .print(X); .include("other.asl", N); !N::hello; .findall(P, .plan_label(_, P), L);
            .length(L, C); .print(C); .include("none.asl").
            -!go[error(E)] <- .print(E).""",
        other_asl="q(1). +!hello <- .print(hello).",
    )
    assert result.lines == ["[a] hello", "[a] 1", "[a] hello", "[a] 5", "[a] internal_action"]


def test_a_wrong_program_is_not_included(ran: Ran) -> None:
    result = ran(
        a_asl="""!go. @same +!go <- .include("other.asl").
            -!go[error(E), error_msg(M)] <- .print(E, " ", M).""",
        other_asl="@ok +!hello <- .print(hello). @same +!hello <- .print(other).",
    )
    assert result.lines == [
        "[a] internal_action .include: cannot include other.asl: another plan has the label same already"
    ] or result.lines == ["[a] internal_action another plan has the label same already"]


def test_a_clone_has_the_mind_of_its_original(ran: Ran) -> None:
    result = ran("""p(1). r(X) :- p(X).
            !count(3). !go.
            +!go <- +p(2); .add_plan({ +!new <- .print(new) }); .clone("b"); .print(cloned);
                .send(b, achieve, show); .send(b, achieve, new).
            +!show <- .findall(X, r(X), L); .my_name(N); .print(N, L).
            +!count(0) <- .print(counted).
            +!count(N) <- !count(N - 1).""")
    assert result.of("a") == ["cloned", "counted"]
    assert sorted(result.of("b")) == ["b[2,1]", "counted", "new"]


def test_a_goal_of_a_clone_gives_its_value_to_the_plan_that_posted_it(ran: Ran) -> None:
    result = ran("""!s. !t. !c. +!a(3). +!c <- .clone("b").
            +!s <- !a(X); .print(X). +!t <- Y = f(Z); !a(Z); .print(Y).""")
    assert sorted(result.of("b")) == sorted(result.of("a")) == ["3", "f(3)"]


def test_the_name_of_a_clone_is_made_unique(ran: Ran) -> None:
    program = "!go. +!go <- .clone(a); .clone(Other); .print(Other); .all_names(N); .print(N)."
    assert ran(program).of("a") == ["other", "[a,a_1,other]"]


def test_a_shutdown_is_announced_to_agents(ran: Ran) -> None:
    result = ran(
        m_mas2j="MAS m { agents: a; b; }",
        a_asl="!go. +!go <- .kill_agent(b, 100); .wait(200); .all_names(N); .print(N); .stopMAS(50, 4).",
        b_asl="+jag_shutting_down(T) <- .print(T); .wait(90); .print(last); .wait(20); .print(never).",
    )
    assert result.lines == ["[b] 100", "[b] last", "[a] [a]"]
    assert result.exit_code == 4


def test_the_end_of_the_run_is_announced_to_all_agents(ran: Ran) -> None:
    result = ran(
        a_asl="!go. +!go <- .stopMAS(70). +jag_shutting_down(T) <- .wait(60); .print(ready(T)).",
    )
    assert result.lines == ["[a] ready(70)"]


@pytest.mark.parametrize("plan", ["+jag_sleeping <- .print(sleep).", "+jag_awaking <- .print(awake)."])
def test_an_agent_gets_events_when_it_sleeps_and_wakes(ran: Ran, plan: str) -> None:
    result = ran(f"!go. +!go <- .wait(10); .print(up); .wait(10). {plan}")
    word = "sleep" if "sleep" in plan else "awake"
    assert sorted(result.of("a")) == sorted(["up", *([word] * (3 if word == "sleep" else 2))])


@pytest.mark.parametrize("word", ["sleeping", "awaking"])
def test_sleep_events_trigger_plans_added_at_run_time(ran: Ran, word: str) -> None:
    result = ran(f"""!go.
            +!go <- .wait(10); .print(up); .add_plan("@p +jag_{word} <- .print({word}).");
                .wait(10); .remove_plan(p); .wait(10); .add_plan("+jag_{word} <- .print(again)."); .wait(10);
                .print(end).""")
    if word == "sleeping":
        assert result.of("a") == ["up", "sleeping", "again", "end", "again"]
    else:
        assert result.of("a") == ["up", "awaking", "end", "again"]


def test_a_clone_shares_no_collections_with_its_original(ran: Ran) -> None:
    result = ran("""!go.
            +!go <- .set.create(S); .set.add(S, 1); .map.create(M); .map.put(M, k, [S]); +held(S, M); .queue.add(Q, S);
                +queued(Q); .clone("b"); .send(b, achieve, change); .wait(10); .print(S, M).
            +!change : held(S, M) & queued(Q) <- .set.add(S, 2); .print(S, M, Q).""")
    assert result.lines == ["[b] {1,2}{k->[{1,2}]}[{1,2}]", "[a] {1}{k->[{1}]}"]


def test_a_message_brings_a_copy_of_a_collection(ran: Ran) -> None:
    result = ran(
        m_mas2j="MAS m { agents: a; b; }",
        a_asl="""!go. +!go <- .set.create(S); .set.add(S, 1); .send(b, tell, box(f(S))); .wait(20); .print(S).""",
        b_asl="+box(f(S)) <- .set.add(S, 2); .print(S).",
    )
    assert result.lines == ["[b] {1,2}", "[a] {1}"]
