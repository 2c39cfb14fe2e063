"""The page about the layout of programs shows the output of `jacaros fmt`."""

from pages import ROOT, blocks

from jacaros.agents.language.formatting import format_program

PAGE = ROOT / "docs" / "reference" / "layout.md"


def test_the_example_is_laid_out_as_the_page_says() -> None:
    (example,) = [block for block in blocks(PAGE) if block.purpose == "formatted"]
    assert format_program("example", example.text) == example.text
