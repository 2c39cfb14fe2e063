"""No text makes the readers of project files crash or hang, and every diagnostic has a valid location."""

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from jacaros.agents.language.diagnostics import Diagnostic, SourceFile
from jacaros.runtime.mas.project.reading import read_project, reader_of

JCM_WORDS = """
mas uses agent workspace artifact institution organisation group scheme node running debug in package
beliefs: goals: join: focus: roles: instances: ag-class: ag-arch: ag-bb-class: verbose: host: node: agents: parent:
focused-by: players: responsible-for: owner: situated: workspaces: asl-path: platform: java-path: world: own:
m bob alice w lab w.a ns::w.a a.B x.asl src/agt "a text" "open 'quoted' 1 -2.5 02 1e3 true p(1,[x]) s(
{ } ( ) [ ] , : :: @ * ; = # | & ! ~ < > \\ // /* */
"""
MAS2J_WORDS = """
MAS infrastructure: environment: executionControl: agents: directives: classpath: aslSourcePath: world: at
agentClass agentArchClass beliefBaseClass beliefs goals verbose events m bob alice a.B x.asl "a text" "open 1 #3 -1
{ } ( ) [ ] , : ; = # . @ * & ! // /* */
"""

LANGUAGES = {
    ".jcm": (JCM_WORDS.split(), "mas m {"),
    ".mas2j": (MAS2J_WORDS.split(), "MAS m { agents:"),
}


def read(suffix: str, text: str) -> list[Diagnostic]:
    diagnostics: list[Diagnostic] = []
    reader_of(SourceFile(f"p{suffix}", text), diagnostics).read()
    lines = text.split("\n")
    for each in diagnostics:
        assert each.span is not None
        assert 1 <= each.span.line <= len(lines)
        assert 1 <= each.span.column <= len(lines[each.span.line - 1]) + 1
        each.render()
    return diagnostics


@pytest.mark.parametrize("suffix", LANGUAGES)
@settings(max_examples=150)
@given(data=st.data())
def test_words_in_any_order_are_read(suffix: str, data: st.DataObject) -> None:
    words, head = LANGUAGES[suffix]
    word_and_gap = st.tuples(st.sampled_from(words), st.sampled_from((" ", "\n", "")))
    drawn = data.draw(st.lists(word_and_gap, max_size=40))
    read(suffix, head + " " + "".join(word + gap for word, gap in drawn))


@pytest.mark.parametrize("suffix", LANGUAGES)
@settings(max_examples=100)
@given(text=st.text(max_size=200))
def test_any_text_is_read(suffix: str, text: str) -> None:
    read(suffix, text)
    read(suffix, LANGUAGES[suffix][1] + text)


@pytest.mark.parametrize("suffix", LANGUAGES)
@pytest.mark.parametrize("sign", ["(", "[", "{", "a(", "group g : t {", "artifact a : A([", "agents: x ["])
def test_endless_brackets_are_refused(suffix: str, sign: str) -> None:
    heads = ("mas m { workspace w { artifact a : A(", "mas m { organisation o {", "MAS m { agents: a [")
    for head in ("", *heads):
        assert read(suffix, head + sign * 5000)


@settings(max_examples=50)
@given(data=st.data())
def test_a_project_with_some_characters_changed_is_resolved(data: st.DataObject, tmp_path_factory):
    folder: Path = tmp_path_factory.mktemp("fuzz")
    text = list(WHOLE)
    for _ in range(data.draw(st.integers(1, 5))):
        place = data.draw(st.integers(0, len(text) - 1))
        text[place : place + data.draw(st.integers(0, 3))] = data.draw(st.sampled_from(SIGNS))
    path = folder / "p.jcm"
    path.write_text("".join(text), encoding="utf-8")
    for each in read_project(path).diagnostics:
        each.render()


SIGNS = ["", *" \n{}()[],:./@*aA1-é", '"', "::"]
WHOLE = """\
mas m uses other {
  agent bob : src/bob.asl {
    instances: 2
    beliefs: p(1), "s", q([a])[x]
    goals: go, stay("here")
    join: w, house/kitchen
    focus: n::w.a, b
    roles: cook in o.g @ n1
    ag-class: my.Agent(1)
    verbose: 2
  }
  workspace w {
    artifact a : A(1, -2.5, "t", [x, true], f(y)) { focused-by: *, n::bob1 }
    artifact b : x.B
    agents: bob
    debug
  }
  workspace kitchen { parent: house host: h1 } workspace house
  institution i : i.sai { workspaces: w }
  organisation o : o.xml {
    group g : t { players: bob cook, bob2 boss owner: bob group h : u }
    scheme s : work { owner: bob debug }
  }
  asl-path: src, "src/agt"
  platform: cartago(), jade("-gui")
  uses package: lib "a:b:1"
  node n1 running @ 10.1.1.1:30
}
"""
