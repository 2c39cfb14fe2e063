"""The page's models by themselves, in the engine of a real browser: any moment of a long run, in bounded memory."""

import asyncio
import re
from pathlib import Path
from typing import Any

import pytest
from devtools import chromium, needs_chromium

from jacaros.look.page.page import STATIC, bundle


def evaluated(tmp_path: Path, entry: str, exports: str, expression: str) -> Any:
    """Return what an expression gives that uses what a module exports."""
    script = bundle(STATIC, entry)
    module = re.findall(r"const (module_\w+)", script)[-1]

    async def drive() -> Any:
        async with chromium() as page:
            await page.evaluate(
                f"{script.replace('(async () =>', '(() =>')}; var {{ {exports} }} = {module}; 0"
            )
            return await page.evaluate(expression)

    return asyncio.run(drive())


PLAYED = """(() => {
  const apply = (map, { key, value }) => { if (value === null) map.delete(key); else map.set(key, value); };
  const fold = new Fold(apply, LIMIT), times = [], all = [];
  let seed = 7;
  const random = (n) => { seed = (seed * 16807) % 2147483647; return seed % n; };
  for (let n = 0; n < 3000; n++) {
    const change = { key: random(50), value: random(4) ? n : null };
    times.push(n / 10); all.push(change); fold.add(n / 10, change);
  }
  const wrong = [], first = all.length - fold.changes.length;
  for (let n = 0; n < 600; n++) {
    const t = (first + random(3000 - first)) / 10, expected = new Map();
    all.forEach((change, i) => { if (times[i] <= t) apply(expected, change); });
    const sorted = (map) => JSON.stringify([...map].sort((a, b) => a[0] - b[0]));
    if (sorted(expected) !== sorted(fold.at(t))) wrong.push(t);
  }
  return [wrong, fold.changes.length, fold.checkpoints.length];
})()"""


@needs_chromium
@pytest.mark.parametrize(("limit", "kept"), [(20000, 3000), (400, 500)])
def test_a_fold_equals_a_replay_from_the_beginning_at_any_time(tmp_path: Path, limit: int, kept: int) -> None:
    wrong, length, checkpoints = evaluated(tmp_path, "fold", "Fold", PLAYED.replace("LIMIT", str(limit)))
    assert wrong == []
    assert length <= kept
    assert checkpoints > 2


@needs_chromium
def test_models_of_a_long_run_stay_small(tmp_path: Path) -> None:
    counts = evaluated(
        tmp_path,
        "causes",
        "Causes",
        """(() => {
          const causes = new Causes();
          for (let id = 1; id <= 250000; id++) {
            causes.add(id, "cause", { id, parent: id - 1, kind: "property", what: "p", at: id });
          }
          const sizes = [causes.links.size, causes.effects.size, causes.order.values.length];
          return [...sizes, causes.chain(250000).length, causes.chain(3).length];
        })()""",
    )
    assert all(count <= 100_001 for count in counts[:3])
    assert counts[3] == 2000, "the longest chain that is followed"
    assert counts[4] == 0


@needs_chromium
def test_a_number_that_is_rounded_to_zero_has_no_minus(tmp_path: Path) -> None:
    shown = "[decimals(-0.004, 2), decimals(-0, 1), decimals(-0.006, 2), decimals(1.005, 1)]"
    assert evaluated(tmp_path, "elements", "decimals", shown) == ["0.00", "0.0", "-0.01", "1.0"]


@needs_chromium
def test_a_fault_has_one_mark(tmp_path: Path) -> None:
    sorts = '["begins", "acts", "ends", "refused"].map((state) => sortOf("fault", { state }) ?? "none")'
    assert evaluated(tmp_path, "happenings", "sortOf", sorts) == ["failure", "none", "none", "failure"]
