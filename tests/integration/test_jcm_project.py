"""A whole project laid out as JaCaMo's tools lay them out, run as it is."""

from pathlib import Path
from textwrap import dedent

import pytest

from jacaros.runtime.mas.checks.files import check_files
from jacaros.testing import run_project

FILES = {
    "auction.jcm": """
        /* An auction on artifacts: one auctioneer, some bidders of two kinds, and an observer. */

        mas auction uses common/hall {

            agent auctioneer {
                goals: open("lamp", 10)
                       open("table", 30)
                join:  hall
            }

            agent bidder {
                instances: 2
                beliefs: limit("lamp", 25), limit("table", 31)
                focus:   hall.board
            }

            agent rich : bidder.asl {
                beliefs: limit("lamp", 40)[source(self)]
                         limit("table", 90)
                roles:   bidder in house.room      // has no effect here
            }

            organisation house : src/org/house.xml {
                group room : roomGroup {
                    players: auctioneer seller,
                             rich       bidder
                    responsible-for: sale
                }
                scheme sale : saleScheme
            }

            asl-path: src/agt, src/agt/inc
            platform: jacamo.rest.JCMRest("--rest-port 8080")
        }
        """,
    "common/hall.jcm": """
        mas common {
            agent watcher { focus: ns::hall.board }
            workspace hall {
                artifact board : market.Board("sales", 2) {
                    focused-by: rich
                }
                agents: *
            }
        }
        """,
    "common/watcher.asl": """
        +ns::sold(What, Who, Price) <- .print(What, " for ", Price).
        +ns::closed(Label) <- .wait(100); .print("end of ", Label); .stopMAS.
        """,
    "src/env/market/Board.py": """
        from jacaros.artifacts import Artifact, operation


        class Board(Artifact):
            def init(self, label: str, wanted: int) -> None:
                self.label, self.wanted = label, wanted

            @operation
            def announce(self, auction: str) -> None:
                self.define_property("auction", auction)

            @operation
            def record(self, what: str, who: str, price: float) -> None:
                self.define_property("sold", what, who, price)
                self.wanted -= 1
                if not self.wanted:
                    self.signal("closed", self.label)
        """,
    "src/env/market/Auction.py": """
        from jacaros.artifacts import Artifact, Out, operation


        class Auction(Artifact):
            def init(self, what: str, least: float) -> None:
                self.what = what
                self.define_property("best", least, "nobody")

            @operation
            def bid(self, price: float) -> None:
                if price <= self.value("best"):
                    self.fail("too low", "too_low", self.value("best"))
                self.update_property("best", price, self.caller)

            @operation
            def close(self, who: Out, price: Out) -> None:
                price.set(self.value("best"))
                who.set(self.value("best", 1))
        """,
    "src/agt/inc/names.asl": """
        name(What, Name) :- .concat("auction_", What, Name).
        """,
    "src/agt/auctioneer.asl": """
        { include("names.asl") }

        +!open(What, Least) : name(What, Name)
          <- makeArtifact(Name, "market.Auction", [What, Least], Id);
             announce(Name);
             .wait(1000);
             close(Who, Price)[artifact_id(Id)];
             disposeArtifact(Id);
             record(What, Who, Price).
        """,
    "src/agt/bidder.asl": """
        { include("names.asl") }

        +auction(Name) : limit(What, _) & name(What, Name) <- lookupArtifact(Name, Id); focus(Id).

        +best(Price, Who)[artifact_name(Name)]
          : .my_name(Me) & .term2string(Me, MyName) & Who \\== MyName &
            limit(What, Limit) & name(What, Art) & .term2string(Name, Art) & Price < Limit
          <- !offer(Price + 5, Name).

        +!offer(Price, Name) <- bid(Price)[artifact_name(Name), wsp("/main/hall")].
        -!offer(_, _)[env_failure_reason(too_low(_))].
        """,
}


@pytest.fixture
def project(tmp_path: Path) -> Path:
    for name, text in FILES.items():
        file = tmp_path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(dedent(text), encoding="utf-8")
    return tmp_path / "auction.jcm"


def test_an_auction_in_jacamos_layout_runs(project: Path) -> None:
    result = run_project(project, seconds=60)
    assert result.exit_code == 0
    lines = result.of("watcher")
    assert lines[-1] == "end of sales"
    sales = {line.split(" for ")[0]: float(line.split(" for ")[1]) for line in lines[:-1]}
    assert set(sales) == {"lamp", "table"}
    assert sales["lamp"] >= 25
    assert sales["table"] >= 31


def test_settings_without_effect_are_logged_once_per_kind(project: Path) -> None:
    result = run_project(project, seconds=60)
    assert [text.splitlines()[0].partition("warning: ")[2] for text in result.errors] == [
        "the role `bidder` in `house.room` has no effect: roles in organisations are not supported",
        "the organisation `house` has no effect: organisations are not supported",
        "the platform `jacamo.rest.JCMRest` has no effect: nodes distribute agents",
    ]


def test_the_checker_finds_nothing_else_in_it(project: Path) -> None:
    found = check_files([project.parent]).diagnostics
    assert [each for each in found if each.code != "no-effect"] == []
