import { button, element, rounded, setText } from "./elements.js";
import { propertyText } from "./environment.js";
import { momentButton, showWhy, whyButton } from "./jumps.js";
import { shortName } from "./link_words.js";
import { Picker } from "./picker.js";
import { keyed, moveByArrows } from "./refill.js";
import { Section, age } from "./section.js";
import { propertyKeys } from "./series_sources.js";

const STANDARD = new Set(["Blackboard", "Console", "ManualRepository", "SystemArtifact", "WorkspaceArtifact"]);  // of every workspace
const LAST = 8;  // operations and signals that are shown

/** The artifacts: a list of all of them, and properties, operations and observers of the selected one. */
export class ArtifactsView {
  constructor(root, context, environment) {
    Object.assign(this, { root, context, environment });
    this.picker = new Picker("artifacts", (row, item) => this.fillRow(row, item), ({ path }) => context.selection.choose({ artifact: path }));
    this.picker.onSearch = () => this.show(this.t);
    this.name = element("h2");
    this.about = element("span", "about");
    this.field = element("input", "entry");
    Object.assign(this.field, { type: "text", spellcheck: false, placeholder: "an operation, such as stop" });
    this.field.setAttribute("aria-label", "Operation");
    this.run = element("button", "plain", "Call");
    this.form = element("form", "console-form", this.field, this.run);
    this.result = element("p", "result");
    this.result.setAttribute("role", "status");
    this.form.addEventListener("submit", (event) => { event.preventDefault(); this.call(); });
    this.sections = [
      new Section("Properties", properties(context)), new Section("Running operations", running(context)),
      new Section("Last operations", operations(context)), new Section("Signals", signals(context)), new Section("Observers", observers(context)),
    ];
    root.append(this.picker.root, element("div", "mind-head", this.name, this.about), this.form, this.result, ...this.sections.map((each) => each.root));
  }

  get empty() { return this.environment.artifacts.size === 0; }

  show(t) {
    this.t = t;
    const { artifacts, version } = this.environment, { artifact, robot } = this.context.selection.current;
    if (this.listed !== version) {
      this.listed = version;
      const rank = ({ artifact: each }) => (STANDARD.has(each.type) ? 1 : 0);
      this.items = [...artifacts.values()].map((each) => ({ name: each.path, path: each.path, artifact: each })).sort((a, b) => rank(a) - rank(b));
    }
    const wanted = artifact ?? (robot && this.items.find((each) => each.artifact.robot === robot)?.path);
    if (artifacts.has(wanted)) this.chosen = wanted;
    if (!artifacts.has(this.chosen)) this.chosen = this.items[0]?.path;
    const shown = artifacts.get(this.chosen);
    if (!shown) return;
    this.picker.show(this.items, this.chosen);
    setText(this.name, shown.name);
    this.about.title = shown.type;
    setText(this.about, [shortName(shown.type), shown.robot ? `of ${shown.robot}` : "", shown.isThere(t) ? "" : "disposed"].filter(Boolean).join(" · "));
    this.form.hidden = this.result.hidden = !this.context.commands.can.has("operate");
    for (const section of this.sections) section.show(shown, t);
  }

  fillRow(row, { path, artifact }) {
    const stamp = `${path} ${artifact.stamp(this.t)}`;
    if (row.dataset.stamp === stamp) return;
    row.dataset.stamp = stamp;
    const [first] = artifact.runningAt(this.t);
    row.replaceChildren(element("span", `dot ${first ? "runs" : artifact.isThere(this.t) ? "idle" : "ended"}`), element("b", "", artifact.name),
      element("span", "doing", first?.operation ?? artifact.propertiesAt(this.t).map(propertyText).join(", ")));
  }

  async call() {
    const text = this.field.value.trim();
    if (!text) return;
    setText(this.result, `${text} runs …`);
    const result = await this.context.actions.run(this.field, () => this.context.commands.send("operate", { artifact: this.chosen, text }));
    setText(this.result, result === undefined ? "" : result || `${text}: done`);
  }
}

function properties(context) {
  return {
    count: (artifact, t) => artifact.properties.at(t).size,
    stamp: (artifact, t) => `${artifact.properties.countAt(t)} ${artifact.properties.between(t - 2, t).length} ${context.curves.stamp}`,
    nodes(artifact, t) {
      const rows = artifact.propertiesAt(t).map((property) => {
        const row = button("belief", () => showWhy(context, { artifact: artifact.path, cause: property.cause || undefined }),
          element("span", "sign", artifact.isRecent(property, t) ? "+" : ""), element("code", "", rounded(propertyText(property))), element("span", "by"), age(property.since));
        row.title = propertyText(property);
        const plot = context.curves.button(propertyKeys(artifact.path, property), propertyText(property));
        return element("li", artifact.isRecent(property, t) ? "recent" : "", keyed(`property ${property.id}`, row), ...(plot ? [keyed(`plot ${property.id}`, plot)] : []));
      });
      if (!rows.length) return [element("p", "empty", "No properties.")];
      const list = element("ul", "beliefs", ...rows);
      moveByArrows(list, ".belief");
      return [list];
    },
  };
}

function running(context) {
  return {
    hideEmpty: true,
    count: (artifact, t) => artifact.running.at(t).size,
    stamp: (artifact, t) => String(artifact.running.countAt(t)),
    nodes: (artifact, t) => [element("ul", "operations", ...artifact.runningAt(t).map((each) => element("li", "", element("code", "", each.operation),
      element("span", "", ` for ${each.agent ?? "itself"}, since `, momentButton(context, each.since, `run ${each.id}`), " · ", age(each.since)), " ",
      whyButton(context, { artifact: artifact.path, cause: each.id }, `run ${each.id}`))))],
  };
}

function operations(context) {
  return {
    count: () => null,
    stamp: (artifact, t) => String(artifact.running.countAt(t)),
    nodes(artifact, t) {
      const last = artifact.lastOperations(t, LAST);
      if (!last.length) return [element("p", "empty", "No operation has been called yet.")];
      return [element("ul", "operations", ...last.map((each) => element("li", each.outcome, element("span", "outcome", OUTCOMES[each.outcome] ?? each.outcome),
        element("code", "", each.operation), element("span", "", ` by ${each.agent ?? "itself"} at `, momentButton(context, each.began, `op ${each.id}`)), " ",
        whyButton(context, { artifact: artifact.path, cause: each.id }, `op ${each.id}`), ...(each.reason ? [element("span", "why", each.reason)] : []))))];
    },
  };
}

const OUTCOMES = { runs: "▶ runs", done: "✓ done", failed: "✗ failed" };

function signals(context) {
  return {
    hideEmpty: true,
    count: (artifact, t) => artifact.signals.countAt(t),
    stamp: (artifact, t) => String(artifact.signals.countAt(t)),
    nodes: (artifact, t) => [element("ul", "operations", ...artifact.lastSignals(t, LAST).map((each, n) => element("li", "", element("code", "", each.signal), " at ",
      momentButton(context, each.t, `signal ${n}`), " ", ...(each.cause ? [whyButton(context, { artifact: artifact.path, cause: each.cause }, `signal ${n}`)] : []))))],
  };
}

function observers(context) {
  return {
    count: (artifact, t) => artifact.observers.at(t).size,
    stamp: (artifact, t) => String(artifact.observers.countAt(t)),
    nodes(artifact, t) {
      const names = artifact.observersAt(t);
      if (!names.length) return [element("p", "empty", "No agent focuses it.")];
      return [element("p", "names", ...names.slice(0, 100).flatMap((agent) => [keyed(`observer ${agent}`, button("jump", () => {
        context.selection.choose({ agent });
        context.open("agents");
      }, agent)), " "]), ...(names.length > 100 ? [`and ${names.length - 100} more`] : []))];
    },
  };
}
