"""Run a program until its robot has moved, so that everything that a run imports is in memory."""

import gc
import json

from jacaros.browser.page import start
from jacaros.runtime.mas.launch import GARBAGE_THRESHOLD

PACKAGES = ["jacaros", "msgspec", "ruamel"]
"""What a run imports from."""

MAPPINGS = ["nav2.yaml", "turtlebot4.yaml"]
PROGRAM = """
!go.
+!go <- navigate_to(1, 0, 0); .print("there"); .wait(100); !back[retry(2)].
+!back <- navigate_to(0, 0, 0).
+battery(P, _) : P < 50 <- .print("low ", P).
"""


def warm_up() -> None:
    posted: list[str] = []
    source = {
        "files": {"warm_up.asl": PROGRAM},
        "main": "warm_up.asl",
        "world": "patrol",
        "mappings": MAPPINGS,
        "seed": 1,
    }
    running = start(json.dumps(source), posted.append, float("inf"))
    asked = False
    while not running.over:
        running.pump(0.05)
        if running.elapsed > 5.0 and not asked:
            asked = True
            running.receive('{"id": 1, "do": "why", "question": "!go"}')
            running.receive('{"id": 2, "do": "story"}')
            running.receive('{"id": 3, "do": "offers", "agent": "warm_up"}')
            running.receive('{"id": 4, "do": "pause"}')
            running.receive('{"id": 5, "do": "continue"}')
        if running.elapsed > 15.0:
            running.stop()
    assert any("there" in each for each in posted), posted


warm_up()
gc.collect()
gc.freeze()
gc.set_threshold(GARBAGE_THRESHOLD, 20, 100)
