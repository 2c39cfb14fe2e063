"""Questions of agents to a person on the live page, in a real browser, and on the page of a recording."""

from devtools import browsing, needs_chromium, replayed

from jacaros.look.page.recorder import Recorder

PROGRAM = """
{ include("$jacaros/artifacts.asl") }
!fetch. !name.
+!fetch
  <- !use_artifact("operator", "Operator");
     ask("Where is the ball?", [kitchen, hall, [0.1234, go(1, "x")]], Place);
     +found(Place).
+!name
  <- .wait({+question(1, _, _)});
     ask("Who are you?", [], Name);
     +name(Name).
+answered(Id, Answer, By) <- +said(Id, By).
"""
on_the_page = browsing(PROGRAM, ".asked")


ANSWERS = "document.querySelectorAll('.answers :is(button, input)')"


@on_the_page
async def test_questions_are_answered_by_keyboard(page) -> None:
    await page.wait_for("document.querySelectorAll('.asked').length === 2")
    await page.wait_for(
        "[...document.querySelectorAll('.asked .who')].every((each) => each.innerText === 'bob')"
    )
    assert await page.texts(".asked .answers button") == ["kitchen", "hall", '[0.123, go(1,"x")]', "Answer"]
    await page.evaluate("document.querySelector('.answers input').focus()")
    await page.type("Ada")
    await page.evaluate(f"{ANSWERS}[2].focus()")
    await page.press("Enter")
    bob = page.mas.agent("bob")
    await bob.until('found([0.1234, go(1, "x")]) & said(1, page)')
    await page.wait_for("document.querySelectorAll('.asked').length === 1")
    # The focus has moved to the next question, and what was typed there is still there.
    await page.press("Enter")
    await bob.until('name("Ada") & said(2, page)')
    await page.wait_for("!document.querySelector('.asked')")


@needs_chromium
async def test_a_recording_shows_a_question_and_takes_no_answer() -> None:
    recorder = Recorder()
    operator = {"artifact": "/main/operator"}
    recorder.event(0.5, "artifact", {**operator, "type": "Operator", "state": "made", "robot": None})
    call = {"id": 3, "operation": 'ask("Say \\"x\\"?",[yes,2],_)', "agent": "bob"}
    recorder.event(1.0, "operation", {**operator, **call, "state": "began"})
    values = [1, 'Say "x"?', ["yes", 2]]
    recorder.event(1.0, "property", {**operator, "name": "question", "key": 1, "values": values})
    recorder.event(4.0, "property", {**operator, "name": "question", "key": 1, "values": None})
    recorder.close()
    async with replayed(recorder.recording) as page:
        assert await page.texts(".asked p") == ['bob asks: Say "x"? Why?']
        assert await page.texts(".answers button") == ["yes", "2"]
        assert await page.evaluate(
            "[...document.querySelectorAll('.answers button')].every((each) => each.disabled)"
        )
