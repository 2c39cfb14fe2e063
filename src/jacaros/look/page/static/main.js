import { Actions } from "./actions.js";
import { AgentsView } from "./agents_view.js";
import { ArtifactsView } from "./artifacts_view.js";
import { Breakpoints } from "./breakpoints.js";
import { Causes } from "./causes.js";
import { CausesView } from "./causes_view.js";
import { ControlsView } from "./controls_view.js";
import { CurveChoice } from "./curve_choice.js";
import { CurveThresholds } from "./curve_thresholds.js";
import { CurvesView } from "./curves_view.js";
import { Debugging } from "./debugging.js";
import { isDark, setText } from "./elements.js";
import { Environment } from "./environment.js";
import { Fleet } from "./fleet.js";
import { FleetView } from "./fleet_view.js";
import { GraphView } from "./graph_view.js";
import { Headline } from "./headline.js";
import { HeadlineView } from "./headline_view.js";
import { listenToKeys } from "./keys.js";
import { Lanes } from "./lanes.js";
import { LanesView } from "./lanes_view.js";
import { Links } from "./links.js";
import { Log } from "./log.js";
import { LogView } from "./log_view.js";
import { MapView } from "./map_view.js";
import { recall, remember } from "./memory.js";
import { Messages } from "./messages.js";
import { MessagesView } from "./messages_view.js";
import { Minds } from "./minds.js";
import { Divider } from "./panes.js";
import { ProgramView } from "./program_view.js";
import { QuestionsView } from "./questions_view.js";
import { RobotsView } from "./robots_view.js";
import { Run } from "./run.js";
import { SeriesSources } from "./series_sources.js";
import { Selection } from "./selection.js";
import { Story, StoryView } from "./story.js";
import { Tabs } from "./tabs.js";
import { Time } from "./time.js";
import { TimeAxis } from "./time_axis.js";
import { TimelineView } from "./timeline.js";
import { TimeView } from "./time_view.js";
import { World } from "./world.js";
import { WorldTools } from "./world_tools.js";

/** What a replay has in place of commands: nothing can be done to a run that is over. */
export const NO_COMMANDS = {
  can: new Set(),
  send: () => Promise.reject(new Error("this page shows a recording")),
  onChange: () => {},
};

/**
 * Put the page together.
 *
 * @param {boolean} live follow the end of the run.
 * @param {object} commands `can`: the set of commands that work, `send(do, args)`: a promise of the result,
 *   `onChange(listener)`: called when `can` has changed.
 * @returns {object} `run`, which takes the records, `time`, `selection`, and `show()`, which draws what has changed.
 */
export function startPage({ live, commands }) {
  const world = new World(), links = new Links(), log = new Log(), minds = new Minds();
  const environment = new Environment(), messages = new Messages(), causes = new Causes(), debugging = new Debugging(), fleet = new Fleet(), lanes = new Lanes();
  const sources = new SeriesSources(world), thresholds = new CurveThresholds(minds, sources);
  const story = new Story();
  const models = [story, world, links, log, minds, environment, messages, causes, debugging, fleet, sources, thresholds, lanes];
  const run = new Run(models), selection = new Selection(), time = new Time(run, live);
  const context = { run, selection, commands, time, open: (panel) => tabs.open(panel), actions: new Actions(), axis: new TimeAxis(time) };
  context.curves = new CurveChoice(sources, thresholds, time);
  context.causes = causes;
  context.breakpoints = new Breakpoints(context, debugging);
  const at = (id) => document.getElementById(id);

  const tabs = new Tabs(at("tabs"), [
    [at("story"), new StoryView(at("story"), context, story)],
    [at("agents"), new AgentsView(at("agents"), context, { minds, links })],
    [at("program"), new ProgramView(at("program"), context, minds)],
    [at("artifacts"), new ArtifactsView(at("artifacts"), context, environment)],
    [at("messages"), new MessagesView(at("messages"), context, messages)],
    [at("fleet"), new FleetView(at("fleet"), context, fleet)],
    [at("graph"), new GraphView(at("graph"), context, environment)],
    [at("causes"), new CausesView(at("causes"), context, { causes, minds, links, environment })],
  ], context);
  const tools = new WorldTools(at("tools"), context, world);
  const map = new MapView(at("map"), context, world, links, tools);
  const headline = new Headline({ log, minds, world, fleet, run, time, story });
  const beside = [
    [at("headline"), new HeadlineView(at("headline"), context, { headline, minds, causes })],
    [at("questions"), new QuestionsView(at("questions"), context, environment)],
    [at("tools"), tools],
    [at("controls"), new ControlsView(at("controls"), context, { debugging, minds })],
    [at("robots"), new RobotsView(at("robots"), context, world, links)],
    [at("log"), new LogView(at("log"), context, log)],
    [at("when"), new TimeView(at("when"), context)],
    [at("lanes"), new LanesView(at("lanes"), context, { lanes, minds, messages })],
    [at("curves"), new CurvesView(at("curves"), context, { sources, thresholds, log })],
    [at("timeline"), new TimelineView(at("timeline"), context, log)],
  ];

  const dividers = [
    new Divider(at("left"), at("right"), "Width of the details"), new Divider(at("stage"), at("when"), "Height of the time panel"),
    new Divider(at("lanes"), at("curves"), "Height of the curves"), new Divider(at("panels"), at("log"), "Size of the log"),
  ];
  const page = new Page({ run, selection, time, axis: context.axis, commands, world, map, tabs, beside, dividers });
  listenToKeys(time);
  page.chooseTheme(fragment().get("theme") ?? recall("theme") ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light"));
  at("theme").addEventListener("click", () => {
    page.chooseTheme(isDark() ? "light" : "dark");
    remember("theme", document.documentElement.dataset.theme);
  });
  tabs.chosen ??= "agents";
  story.onTold(() => {  // a replay opens with its story, at the first failure
    if (time.canBeLive || fragment().has("t")) return;
    tabs.chosen = "story";
    time.go(story.lines.find(({ level }) => level === "error")?.t ?? 0);
  });
  page.begin();
  return page;
}

/** Parameters behind the # of the address: `t`, seconds; `theme`, light or dark; `curves`, keys of sources (`CurveChoice`). */
export function fragment() { return new URLSearchParams(location.hash.slice(1)); }

/** Draws the views, at most once for each animation frame, and only when something has changed. */
class Page {
  constructor(parts) {
    Object.assign(this, parts);
    this.line = "";
    this.isStale = true;
  }

  begin() {
    const stale = () => { this.isStale = true; };
    this.run.onChange(stale);
    this.time.onChange(stale);
    this.axis.onChange(stale);
    this.selection.onChange(stale);
    this.commands.onChange(stale);
    const sizes = new ResizeObserver(stale);
    for (const id of ["map", "timeline", "log", "when", "lanes", "curves"]) sizes.observe(document.getElementById(id));
    document.body.classList.remove("starting");
    const tick = (moment) => {
      this.tick(this.last === undefined ? 0 : Math.min(0.25, (moment - this.last) / 1000));
      this.last = moment;
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  tick(seconds) {
    if (this.time.tick(seconds)) this.isStale = true;
    if (this.isStale) this.show();
  }

  show() {
    this.isStale = false;
    const t = this.time.now;
    const { world, map } = this;
    document.getElementById("stage").hidden = world.empty;
    this.attempt(() => this.tabs.show(t));
    const bare = this.tabs.available.length === 0;
    document.getElementById("nothing").hidden = !bare;
    document.body.classList.toggle("no-panels", bare && !world.empty);
    for (const [root, view] of this.beside) {
      root.hidden = view.empty === true;
      // Controls also say, beside them, that the run is paused: they have to take this back when the run has ended.
      if (!root.hidden || view.showsAlways) this.attempt(() => view.show(t));
    }
    for (const divider of this.dividers) divider.show();
    if (!world.empty) this.attempt(() => map.show(t));  // last: the others decide how much room is left for it
    this.summarise(t);
    this.showNotice();
  }

  /** Draw one view: records that it cannot show must not hide the others. */
  attempt(draw) {
    try { draw(); } catch (error) {
      this.run.reject("page", error);
      console.error(error);
    }
  }

  summarise(t) {
    const robots = this.world.robotCount, name = this.world.drawing(t).name, parts = [];
    if (name && name !== document.getElementById("title").textContent) parts.push(name);
    if (robots) parts.push(robots === 1 ? "1 robot" : `${robots} robots`);
    setText(document.getElementById("summary"), parts.join(" · "));
  }

  chooseTheme(theme) {
    document.documentElement.dataset.theme = theme;
    setText(document.getElementById("theme"), theme === "dark" ? "Light" : "Dark");
    document.getElementById("theme").setAttribute("aria-label", theme === "dark" ? "Use light colours" : "Use dark colours");
    this.map.invalidate();
    this.isStale = true;
  }

  setTitle(title) {
    document.title = title;
    setText(document.getElementById("title"), title);
  }

  /** Show a line about the page itself, such as a lost connection; "" removes it. */
  notice(text) {
    this.line = text;
    this.showNotice();
  }

  showNotice() {
    const text = [this.line, this.run.warning].filter(Boolean).join(" "), notice = document.getElementById("notice");
    setText(notice, text);
    notice.hidden = !text;
  }
}
