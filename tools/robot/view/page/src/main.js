// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
import { State, mayDrive } from "./state.js";
import { MapView, LEGEND, COLOUR } from "./map.js";
import { drawErrors, drawPatterns } from "./charts.js";
import { headline, showDrive, showEvents, showHealth, showLearned, showRobot } from "./cards.js";
import { Connection } from "./connection.js";

const ALIVE = 200; // [ms] between signs of life to the operator console
const FRESH = 500; // [ms] age limit of the picture for holding the robot
const WORDS = 100; // [ms] between updates of the cards: nobody reads faster
const element = (id) => document.getElementById(id);

let state = new State();
const map = new MapView(element("map"), state);
let connected = false;
let mayCommand = false;
let asked = 0; // number of the newest seek
let seeking = null; // [us] position of the slider
let holds = false; // this page has taken the robot
let tool = null; // "goal" or "fence": what a click on the map means
let timeAt = null; // pixel of the chart -> time
let drawn = 0; // [ms] time of the last picture
let shown = 0; // [us] arrival of the newest MOTOR shown, by the server's clock


// Relative to the page, for any proxy path.
const beside = new URL(`./${location.search}`, location.href);
beside.protocol = location.protocol === "https:" ? "wss:" : "ws:";
const connection = new Connection(beside.href, {
  onMessage(topic, message, time) {
    state.take(topic, message, time, performance.now());
    if (topic === "view/player") playerMoved();
  },
  onOpen(allowed) {
    connected = true;
    mayCommand = allowed;
    // Another server, or the same one after a pause: discard the old data.
    state = new State();
    map.state = state;
    notice("");
  },
  onClose() {
    connected = false;
    holds = false;
  },
  onStatus({ message }) { notice(message.replace(/^console: /, "")); },
});

function notice(words) { element("notice").textContent = words; }

// Time of a log.

function playerMoved() {
  const { player } = state;
  if (player.live) return;
  if (seeking !== null && player.answered === asked) {
    const wanted = seeking;
    seeking = null;
    if (Math.abs(wanted - player.now) > 1000) seek(wanted);
  }
}

// One request at a time: the slider moves faster than a log can be read.
function seek(time) {
  const { player } = state;
  if (!player || player.live) return;
  const clamped = Math.round(Math.min(player.end, Math.max(player.begin, time)));
  if (seeking === null) {
    asked += 1;
    connection.control({ op: "seek", time: clamped, request: asked });
  }
  seeking = clamped;
}

element("slider").addEventListener("input", (event) => {
  const { player } = state;
  if (player && !player.live) seek(player.begin + (Number(event.target.value) / 1000) * (player.end - player.begin));
});
const toggle = () => connection.control({ op: state.player?.playing ? "pause" : "play", speed: Number(element("speed").value) });
element("play").addEventListener("click", toggle);
element("speed").addEventListener("change", () => state.player?.playing && connection.control({ op: "play", speed: Number(element("speed").value) }));
element("errors").addEventListener("click", (event) => timeAt && seek(timeAt(event.offsetX)));
element("events").addEventListener("click", (event) => {
  const row = event.target.closest(".event");
  if (row) seek(Number(row.dataset.time));
});

// Operating the robot.

// The E-stop is always available: the displayed state may be old.
element("estop").addEventListener("click", () => connection.command({ op: "estop" }));
element("clear").addEventListener("click", () => connection.command({ op: "clear_estop" }));
// A command that moves the robot carries the time of the newest displayed state; the operator console refuses an outdated page.
const operate = (message) => connection.command({ ...message, seen: shown });
element("arm").addEventListener("click", () => { holds = true; operate({ op: "arm" }); });
element("disarm").addEventListener("click", () => { holds = false; connection.command({ op: "disarm" }); });
element("cancel").addEventListener("click", () => connection.command({ op: "cancel" }));
function choose(wanted) {
  tool = tool === wanted ? null : wanted;
  for (const name of ["goal", "fence"]) element(name).classList.toggle("on", tool === name);
  element("finish").hidden = tool !== "fence";
  if (tool !== "fence") map.draft = [];
}
element("goal").addEventListener("click", () => choose("goal"));
element("fence").addEventListener("click", () => choose("fence"));
element("finish").addEventListener("click", () => {
  if (map.draft.length >= 3)
        operate({ op: "fence", name: `page ${new Date().toISOString().slice(11, 19)}`, keep_out: true,
      corners: map.draft.map(({ x, y }) => [x, y]) });
  choose("fence");
});
// The robot moves only while somebody can see this page.
setInterval(() => {
  if (holds && !document.hidden && performance.now() - drawn < FRESH) operate({ op: "alive" });
}, ALIVE);

document.addEventListener("keydown", (event) => {
  if (["INPUT", "SELECT"].includes(event.target.tagName) && event.target.type !== "range") return;
  if (event.code === "Space") {
    event.preventDefault();
        if (state.live && mayCommand && !event.repeat) connection.command({ op: "estop" });
  } else if (event.key === "p") toggle();
  else if (event.key === "Escape") choose(null);
});

// The map under the pointer.

const pointers = new Map();
let dragged = 0;
const canvas = element("map");
canvas.addEventListener("pointerdown", (event) => {
  canvas.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
  dragged = 0;
  if (tool === "goal") map.wanted = { ...map.toMap(event.offsetX, event.offsetY), yaw: null };
});
canvas.addEventListener("pointermove", (event) => {
  const last = pointers.get(event.pointerId);
  if (!last) return;
  const at = { x: event.offsetX, y: event.offsetY };
  dragged += Math.hypot(at.x - last.x, at.y - last.y);
  const others = [...pointers].filter(([id]) => id !== event.pointerId).map(([, point]) => point);
  if (others.length > 0) {
    const before = Math.hypot(last.x - others[0].x, last.y - others[0].y);
    map.zoom(Math.hypot(at.x - others[0].x, at.y - others[0].y) / Math.max(1, before), others[0].x, others[0].y);
  } else if (map.wanted) {
    const there = map.toMap(at.x, at.y);
    if (dragged > 12) map.wanted.yaw = Math.atan2(there.y - map.wanted.y, there.x - map.wanted.x);
  } else if (dragged > 4) {
    setFollow(false);
    map.centre.x -= (at.x - last.x) / map.scale;
    map.centre.y += (at.y - last.y) / map.scale;
  }
  pointers.set(event.pointerId, at);
});
canvas.addEventListener("pointerup", (event) => {
  pointers.delete(event.pointerId);
  if (map.wanted) {
    const { x, y, yaw } = map.wanted;
    holds = true;
        operate(yaw === null ? { op: "goal", x, y } : { op: "goal", x, y, yaw });
    map.wanted = null;
    choose("goal");
  } else if (tool === "fence" && dragged < 6) map.draft.push(map.toMap(event.offsetX, event.offsetY));
});
canvas.addEventListener("pointercancel", (event) => { pointers.delete(event.pointerId); map.wanted = null; });
canvas.addEventListener("wheel", (event) => {
  event.preventDefault();
  map.zoom(Math.exp(-event.deltaY * 0.0015), event.offsetX, event.offsetY);
}, { passive: false });
function setFollow(on) {
  map.follow = on;
  element("follow").classList.toggle("on", on);
}
element("follow").addEventListener("click", () => setFollow(!map.follow));
element("zoomin").addEventListener("click", () => map.zoom(1.4));
element("zoomout").addEventListener("click", () => map.zoom(1 / 1.4));

element("legend").innerHTML = LEGEND.map(([name, words, kind]) =>
  `<span><i style="background:${COLOUR[name]};${kind === "line" ? "height:.2rem;vertical-align:middle" : kind === "dot" ? "width:.3rem;height:.3rem;vertical-align:middle" : "border:1px solid #6b7680"}"></i>${words}</span>`).join("") +
  "<span><i class=\"nose\">&#9654;</i>robot, nose ahead</span>";

// Drawing.

function span() {
  const { history, player } = state;
  if (player && !player.live) return [player.begin, player.end];
  const first = history.events[0]?.[0] ?? history.way[0]?.[0] ?? player?.now ?? 0;
  const last = Math.max(player?.now ?? 0, first + 60e6);
  return [Math.max(first, last - 600e6), last];
}

let worded = 0;
function frame(clock) {
  requestAnimationFrame(frame);
  try {
    map.draw(clock);
    if (clock - worded > WORDS) {
      worded = clock;
      words(clock);
    }
    drawn = performance.now();
    shown = state.get("MOTOR")?.time ?? 0;
  } catch (error) {
    // A frozen picture sends no sign of life, which releases the robot.
    notice(`this page cannot draw the data: ${error.message}`);
    console.error(error);
  }
}

function words(clock) {
  const mode = element("mode");
  const name = !connected ? "no connection" : state.player === null ? "connecting" : state.live ? "live" : "log";
  mode.textContent = name.toUpperCase();
  mode.className = `badge ${!connected ? "lost" : state.player === null ? "" : state.live ? "live" : "log"}`;
  element("headline").textContent = connected ? headline(state) : "no connection to tread-view: the data shown are old";
  document.body.classList.toggle("lost", !connected);
    const operates = connected && state.live && mayCommand;
  element("estop").hidden = !operates;
  element("operate").hidden = !operates;
  const motor = state.get("MOTOR")?.message;
  element("arm").disabled = !motor || mayDrive(motor.bridge_state);
  element("clear").hidden = !(motor?.bridge_state === 5 && state.age(state.get("MOTOR"), clock) < 0.5);

  showRobot(state, clock);
  showDrive(state, clock);
  showLearned(state, clock);
  showHealth(state, clock);
  const [begin, end] = span();
  showEvents(state, begin);
  timeAt = drawErrors(element("errors"), state, [begin, end]);
  drawPatterns(element("patterns"), state, state.get("LEARNING")?.message.learned_pattern_id);
  element("scale").textContent = `grid ${map.step} m`;
  const { player } = state;
  element("player").hidden = !player || player.live;
  if (player && !player.live) {
    const now = seeking ?? player.now;
    if (document.activeElement !== element("slider") || seeking === null)
      element("slider").value = String((1000 * (now - player.begin)) / Math.max(1, player.end - player.begin));
    element("clock").textContent = `${((now - player.begin) / 1e6).toFixed(1)} of ${((player.end - player.begin) / 1e6).toFixed(0)} s`;
    element("play").textContent = player.playing ? "pause" : "play";
  }
}
requestAnimationFrame(frame);

// For tests.
window.treadView = { state: () => state, map };
