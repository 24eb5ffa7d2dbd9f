// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// State of the page: the newest message of each channel with its times of recording and arrival.

// Numbers that JSON lacks are sent as texts.
export const number = (value) => (typeof value === "number" ? value : Number(value));
export const known = (value) => Number.isFinite(number(value));

const MOTOR = ["disarmed", "armed", "driving", "stopping", "FAULT", "E-STOP", "by hand"];
const PLAN = ["no goal", "driving", "arrived", "waiting", "blocked", "cannot be reached", "stopped"];
export const motorWord = (state) => MOTOR[state] ?? "unknown";
export const planWord = (state) => PLAN[state] ?? "unknown";
export const mayDrive = (state) => [1, 2, 3, 6].includes(state);

// A sender can invent any number of names and places, so the oldest are dropped.
const MOST = { processes: 64, tiles: 8192, patterns: 2048, fences: 256, history: 20000 };
function keep(map, key, value, most) {
  map.delete(key);
  map.set(key, value);
  if (map.size > most) map.delete(map.keys().next().value);
}

export class State {
  constructor() {
    this.latest = new Map(); // topic -> { message, time [us], arrived [ms] }
    this.health = new Map(); // process -> the same
    this.tiles = new Map(); // "x,y" -> { time, tile, image }
    this.patterns = new Map(); // part -> pattern
    this.before = new Map(); // part -> the pattern before the newest change
    this.history = { events: [], patterns: [], way: [], battery: [] };
    this.player = null;
    this.offered = {};
    this.outline = { front: 0.65, rear: 0.65, half_width: 0.34 };
    this.outlineKnown = false;
    this.run = null; // the running pattern: { execution, pattern, start }
    this.fences = new Map();
    this.keepers = new Map();
  }

  get live() {
    return this.player === null || this.player.live;
  }

  // [us] time of the displayed data.
  now() {
    return this.live ? Infinity : this.player.now + 1;
  }

  take(topic, message, time, arrived) {
    if (topic === "view/history") return this.takeHistory(message);
    if (topic === "view/player") {
      this.player = message;
      this.offered = message.channels ?? this.offered;
      return;
    }
    const entry = { message, time, arrived };
    if (topic === "HEALTH") keep(this.health, message.process, entry, MOST.processes);
    else if (topic === "MAP") keep(this.tiles, `${message.tile_x},${message.tile_y}`, { time, tile: message, image: null }, MOST.tiles);
    else if (topic === "PATTERN_SET") this.takePattern(message, time);
    else if (topic === "CONFIG") this.takeConfig(message);
    else if (topic === "FENCE") this.takeFence(message, time);
    else if (topic === "FENCES") keep(this.keepers, message.keeper, { fences: message.fences, time }, MOST.processes);
    else this.latest.set(topic, entry);
    if (topic === "PROGRAM") this.takeProgram(message, time);
  }

  get(topic) {
    const entry = this.latest.get(topic);
    return entry && entry.time <= this.now() ? entry : null;
  }

  // [s] age: since arrival, or for a log since recording.
  age(entry, clock) {
    return this.live ? (clock - entry.arrived) / 1000 : (this.player.now - entry.time) / 1e6;
  }

  takeHistory(message) {
    if (message.from_start) this.history = { events: [], patterns: [], way: [], battery: [] };
    for (const list of ["events", "patterns", "way", "battery"]) this.history[list] = this.history[list].concat(message[list]).slice(this.live ? -MOST.history : 0);
  }

  takePattern(part, time) {
    const known = this.patterns.get(part.part);
    const pattern = { id: part.set_pattern_id, name: part.pattern_name, version: part.set_version, time,
      trajectory: part.trajectory, key: part.trajectory.join() };
    if (known && known.name === pattern.name && known.key !== pattern.key) keep(this.before, part.part, known, MOST.patterns);
    if (!known || known.key !== pattern.key || known.name !== pattern.name || time < known.time) keep(this.patterns, part.part, pattern, MOST.patterns);
  }

  takeConfig(config) {
    if (config.config_process !== "mapping" && config.config_process !== "planner") return;
    const found = /outline:\s*\n\s*front: ([\d.]+)\s*\n\s*rear: ([\d.]+)\s*\n\s*half_width: ([\d.]+)/.exec(config.config_text);
    if (!found) return;
    this.outline = { front: Number(found[1]), rear: Number(found[2]), half_width: Number(found[3]) };
    this.outlineKnown = true;
  }

  takeFence(fence, time) {
    keep(this.fences, fence.fence_name, { ...fence, time }, MOST.fences);
  }

  // The fences in force at the displayed time.
  standingFences() {
    // The FENCES of a process override requests.
    const kept = [...this.keepers.values()].filter((keeper) => keeper.time <= this.now()).flatMap((keeper) => keeper.fences);
    if (kept.length > 0 || this.keepers.size > 0) return [...new Map(kept.map((fence) => [JSON.stringify([fence.fence_name, fence.corners]), fence])).values()];
    return [...this.fences.values()].filter((fence) => fence.fence_kind !== 0 && fence.time <= this.now());
  }

  takeProgram(program, time) {
    const slot = program.running;
    if (slot.execution_id === 0) this.run = null;
    else if (!this.run || this.run.execution !== slot.execution_id) {
      const pose = this.pose();
      this.run = pose && { execution: slot.execution_id, pattern: slot.slot_pattern_id, start: pose, time };
    }
  }

  pattern(id) {
    for (const pattern of this.patterns.values()) if (pattern.id === id) return pattern;
    return null;
  }

  pose() {
    const ins = this.get("INS");
    if (!ins) return null;
    const [x, y] = ins.message.position.map(number);
        const q = ins.message.orientation.map(number);
    if (!Number.isFinite(x + y + q[0] + q[3])) return null;
    const yaw = Math.atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] * q[2] + q[3] * q[3]));
    return { x, y, yaw };
  }
}
