import { rounded, themeColor } from "./elements.js";
import { KIND } from "./lanes_bars.js";
import { fitted } from "./time_canvas.js";

const MERGED = 4, NEAR = 7;  // pixels: bars, and marks, that fit into them come together
const LETTER = 6.03;  // pixels of a letter of the font
const FONT = "10px ui-monospace, Menlo, Consolas, 'DejaVu Sans Mono', monospace";
const COLOURS = ["accent", "accent", "warn", "muted", "good", "bad", "bad", "warn"];  // by kind
const SOLID = [0.55, 0.3, 0.35, 0.2, 0.45, 0.6, 0.9, 0.8];  // how opaque a kind is

/** Draws lanes on a canvas: only what is in view, and nothing that is narrower than four pixels by itself. */
export class LanesDrawing {
  constructor(canvas, axis) { Object.assign(this, { canvas, axis }); }

  /**
   * @param {object[]} rows `bars`, `sort`, `y`, `height`, `label`; those in view are drawn.
   * @param {object} scene `top`: pixels that are scrolled away; `width`, `height`; `end` of the run; `selected(what)`;
   *   `current`: the bar that the pointer or the keys are at; `messages`: arrows from `x`, `from` to `end`, `to`.
   */
  draw(rows, scene) {
    const { axis } = this, pen = this.pen = fitted(this.canvas, scene.width, scene.height);
    // Asking for a colour of the theme is dear for what is done ten thousand times.
    Object.assign(this, { scene, colours: COLOURS.map(themeColor), ink: themeColor("ink") });
    pen.font = FONT;
    pen.textBaseline = "middle";
    const seen = rows.filter(({ y, height }) => y + height > scene.top && y < scene.top + scene.height);
    pen.save();
    pen.translate(0, -scene.top);
    this.drawGrid(rows);
    pen.beginPath();
    pen.rect(axis.left, scene.top, axis.width + 8, scene.height);
    pen.save();
    pen.clip();
    for (const row of seen) if (row.bars) this[row.isMarks ? "drawMarks" : "drawBars"](row);
    this.drawMessages(scene.messages);
    for (const row of seen) if (row.failures) this.drawMarks({ ...row, bars: row.failures });
    this.drawCurrent(scene.current);
    pen.restore();
    for (const row of seen) this.drawLabel(row);
    pen.restore();
  }

  drawGrid(rows) {
    const { pen, scene, axis } = this;
    pen.fillStyle = themeColor("grid");
    for (const t of axis.ticks()) pen.fillRect(Math.round(axis.x(t)), scene.top, 1, scene.height);
    pen.fillStyle = themeColor("line");
    for (const { isFirst, y } of rows) if (isFirst) pen.fillRect(0, y - 2, scene.width, 0.5);
  }

  drawBars(row) {
    const { axis, scene } = this, { bars } = row, run = { root: null, from: 0, to: 0 };
    bars.each(axis.from, axis.to, MERGED * axis.grain, (first, end, sums) => {
      const from = axis.x(bars.starts[first]), to = Math.max(from + 1, axis.x(Math.min(scene.end, bars.ends[end - 1])));
      if (end - first > 1) {
        if (run.root) this.label(row, run);
        this.drawStrip(row, from, to, sums);
        return;
      }
      const what = bars.whats[first], root = what.root ?? what;
      if (root !== run.root) {
        this.label(row, run);
        Object.assign(run, { root, from, text: root.goal ?? root.operation ?? root.holder, words: "" });
      }
      this.drawBar(row, bars.kinds[first], from, to);
      if (what.words && !run.words && to - from > 60) Object.assign(run, { words: rounded(what.words).replace(/^the (action )?/, ""), wordsAt: from });
      run.to = to;
    });
    this.label(row, run);
  }

  drawBar({ y, height }, kind, from, to) {
    const { pen } = this, width = Math.max(1, to - from - (to - from > 4 ? 0.6 : 0));
    pen.fillStyle = this.colours[kind];
    pen.globalAlpha = SOLID[kind];
    if (kind === KIND.waits) pen.fillRect(from, y + height * 0.25, width, height * 0.5);
    else pen.fillRect(from, y, width, height);
    pen.globalAlpha = 1;
    if (kind === KIND.suspended && width > 12) {
      pen.setLineDash([3, 2]);
      pen.strokeStyle = pen.fillStyle;
      pen.lineWidth = 1;
      pen.strokeRect(from + 0.5, y + 0.5, width - 1, height - 1);
      pen.setLineDash([]);
    }
  }

  /** Bars that are too narrow: the kind that took most of the time, and how much of it was taken. */
  drawStrip({ y, height }, from, to, sums) {
    const { pen } = this, kind = sums.indexOf(Math.max(...sums)), all = sums.reduce((one, other) => one + other);
    pen.fillStyle = this.colours[kind];
    pen.globalAlpha = SOLID[kind] * (0.3 + 0.7 * Math.min(1, all / ((to - from) * this.axis.grain)));
    pen.fillRect(from, y, to - from, height);
    pen.globalAlpha = 1;
  }

  /** Write what a bar is for, where it fits; then forget it. */
  label({ y, height }, run) {
    const { pen, axis, scene } = this, { root, text = "", words, wordsAt } = run, from = Math.max(run.from, axis.left) + 3;
    run.root = null;
    if (!root) return;
    if (scene.selected(root)) {
      pen.fillStyle = this.ink;
      pen.fillRect(run.from, y + height - 1.5, run.to - run.from, 1.5);
    }
    if (height < 9 || run.to - from < 4 * LETTER) return;
    const shown = cut(rounded(text), run.to - from - 2);
    if (shown.length < 3) return;
    pen.fillStyle = this.ink;
    pen.textAlign = "left";
    pen.fillText(shown, from, y + height / 2 + 0.5);
    const after = Math.max(wordsAt + 3, from + (shown.length + 2) * LETTER), more = words ? cut(words, run.to - after - 2) : "";
    pen.globalAlpha = 0.7;
    if (more.length > 4) pen.fillText(more, after, y + height / 2 + 0.5);
    pen.globalAlpha = 1;
  }

  /** Marks: filled for a lost goal, hollow for a failure that a plan handled, and ticks for plans that were refused. */
  drawMarks({ bars, y, height, sort }) {
    const { axis, pen } = this;
    bars.each(axis.from, axis.to, NEAR * axis.grain, (first, end, sums) => {
      const x = axis.x(bars.starts[first]), last = axis.x(bars.starts[end - 1]);
      if (sort === "refusals") {
        const isAll = sums[KIND.refused] > 0;
        pen.fillStyle = themeColor(isAll ? "warn" : "muted");
        pen.globalAlpha = isAll ? 1 : 0.5;
        pen.fillRect(x, y + (isAll ? 0 : height / 2), Math.max(1.5, last - x), isAll ? height : height / 2);
        pen.globalAlpha = 1;
        return;
      }
      const size = 7, top = y + height / 2 - size / 2;
      pen.fillStyle = themeColor(sums[KIND.failed] > 0 ? "bad" : "surface");
      pen.strokeStyle = themeColor("bad");
      pen.lineWidth = 1.5;
      pen.fillRect(x - size / 2, top, size, size);
      pen.strokeRect(x - size / 2, top, size, size);
    });
  }

  drawMessages(messages) {
    const { pen } = this, last = new Map();  // by pair of rows: the pixel of the last arrow
    pen.strokeStyle = pen.fillStyle = themeColor("person");
    for (const { x, end, from, to } of messages) {
      const key = from * 1e5 + to, down = Math.sign(to - from);
      if (x - (last.get(key) ?? -Infinity) < 3) continue;
      last.set(key, x);
      pen.lineWidth = 1;
      pen.beginPath();
      pen.moveTo(x, from);
      pen.lineTo(end, to);
      pen.stroke();
      pen.beginPath();
      pen.moveTo(end, to);
      pen.lineTo(end - 3, to - 5 * down);
      pen.lineTo(end + 3, to - 5 * down);
      pen.fill();
    }
  }

  drawCurrent(current) {
    if (!current) return;
    const { pen, axis, scene } = this, { row, index } = current, { bars } = row, root = bars.whats[index].root;
    const from = axis.x(root?.from ?? bars.starts[index]), to = axis.x(Math.min(scene.end, root ? root.to ?? Infinity : bars.ends[index]));
    pen.strokeStyle = this.ink;
    pen.lineWidth = 1.5;
    pen.strokeRect(from - 1, row.y - 1, Math.max(3, to - from + 2), row.height + 2);
  }

  drawLabel({ label, y, height, sort, isOpen, isChosen }) {
    if (!label) return;
    const { pen, axis } = this, sign = isOpen === undefined ? "" : isOpen ? "▾ " : "▸ ";
    pen.fillStyle = themeColor({ states: "ink", refusals: "warn" }[sort] ?? "muted");
    pen.textAlign = "left";
    if (isChosen) pen.font = `bold ${FONT}`;
    pen.fillText(sign + cut(label, axis.left - 26), 8, y + height / 2 + 0.5);
    pen.font = FONT;
  }
}

function cut(text, width) {
  const most = Math.floor(width / LETTER);
  return text.length <= most ? text : most < 3 ? "" : `${text.slice(0, most - 1)}…`;
}
