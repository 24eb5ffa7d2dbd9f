// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The map from above: ground, obstacles and unknown, the robot, its plan and the tree, goal and fences.
import { number, known } from "./state.js";

// Okabe and Ito's colours, distinguishable also with red-green colour blindness.
export const COLOUR = { robot: "#0072b2", plan: "#e69f00", tree: "#56b4e9", goal: "#009e73", way: "#0072b2", scan: "#cc79a7",
  obstacle: "#1c2126", free: "#f7f8f8", unknown: "#c9ced3", fence: "#d55e00" };

export const LEGEND = [["obstacle", "obstacle", "box"], ["free", "free ground", "box"], ["unknown", "not seen yet", "box"],
  ["plan", "plan, with two standard deviations", "line"], ["tree", "search tree", "line"], ["goal", "goal", "box"],
    ["way", "driven path", "line"], ["scan", "newest scan", "dot"]];

const compose = (a, b) => ({ x: a.x + Math.cos(a.yaw) * b.x - Math.sin(a.yaw) * b.y,
  y: a.y + Math.sin(a.yaw) * b.x + Math.cos(a.yaw) * b.y, yaw: a.yaw + b.yaw });

export class MapView {
  constructor(canvas, state) {
    this.canvas = canvas;
    this.state = state;
    this.scale = 40; // pixels per metre
    this.centre = { x: 0, y: 0 };
    this.follow = true;
    this.draft = []; // corners of a fence being drawn
    this.wanted = null; // a goal being set: { x, y, yaw }
  }

  resize() {
    const ratio = window.devicePixelRatio || 1;
    const { clientWidth, clientHeight } = this.canvas;
    if (this.canvas.width !== Math.round(clientWidth * ratio) || this.canvas.height !== Math.round(clientHeight * ratio)) {
      this.canvas.width = Math.round(clientWidth * ratio);
      this.canvas.height = Math.round(clientHeight * ratio);
    }
    this.width = clientWidth;
    this.height = clientHeight;
    this.context = this.canvas.getContext("2d");
    this.context.setTransform(ratio, 0, 0, ratio, 0, 0);
  }

  px(x) { return this.width / 2 + (x - this.centre.x) * this.scale; }
  py(y) { return this.height / 2 - (y - this.centre.y) * this.scale; }
  toMap(px, py) {
    return { x: this.centre.x + (px - this.width / 2) / this.scale, y: this.centre.y - (py - this.height / 2) / this.scale };
  }

  zoom(factor, px = this.width / 2, py = this.height / 2) {
    const before = this.toMap(px, py);
    this.scale = Math.min(400, Math.max(3, this.scale * factor));
    if (this.follow) return;
    const after = this.toMap(px, py);
    this.centre.x += before.x - after.x;
    this.centre.y += before.y - after.y;
  }

  draw(clock) {
    this.resize();
    const pose = this.state.pose();
    if (pose && this.follow) this.centre = { x: pose.x, y: pose.y };
    const c = this.context;
    c.fillStyle = COLOUR.unknown;
    c.fillRect(0, 0, this.width, this.height);
    this.drawTiles();
    this.drawGrid();
    this.drawWay();
    this.drawFences();
    this.faded("PLAN_TREE", clock, () => this.drawTree());
    this.faded("PLAN", clock, () => this.drawPlan());
    this.faded("PROGRAM", clock, () => this.drawRun());
    this.faded("SCAN", clock, () => this.drawScan());
    this.drawGoal();
    const ins = this.state.get("INS");
    if (pose) this.drawRobot(pose, ins ? this.state.age(ins, clock) > 0.5 : true);
  }

  // Data older than three periods of their channel, and than 1 s, fade.
  faded(topic, clock, draw) {
    const entry = this.state.get(topic);
    if (!entry) return;
    const [rate] = this.state.offered[topic] ?? [1];
    const stale = this.state.age(entry, clock) > Math.max(1, 3 / Math.max(rate, 0.1));
    this.context.globalAlpha = stale ? 0.25 : 1;
    draw();
    this.context.globalAlpha = 1;
  }

  tileImage(entry) {
    if (entry.image) return entry.image;
    const { tile } = entry;
    const side = tile.tile_cells;
    const image = new OffscreenCanvas(side, side);
    const context = image.getContext("2d");
    const pixels = context.createImageData(side, side);
    const cells = Uint8Array.from(atob(tile.cells), (letter) => letter.charCodeAt(0));
    for (let i = 0; i < cells.length; ++i) {
      const row = side - 1 - Math.floor(i / side);
      const at = 4 * (row * side + (i % side));
      const cell = cells[i];
      if (cell === 255) continue; // unknown: the ground colour shows
      const shade = cell === 254 ? 28 : 247 - Math.round(cell * 1.2);
      pixels.data[at] = cell === 254 ? 28 : shade;
      pixels.data[at + 1] = cell === 254 ? 33 : shade;
      pixels.data[at + 2] = cell === 254 ? 38 : Math.max(0, shade - cell);
      pixels.data[at + 3] = 255;
    }
    context.putImageData(pixels, 0, 0);
    entry.image = image;
    return image;
  }

  drawTiles() {
    const now = this.state.now();
    this.context.imageSmoothingEnabled = false;
    for (const entry of this.state.tiles.values()) {
      if (entry.time > now) continue;
      const { tile } = entry;
      const side = tile.tile_cells * tile.cell_size;
      const left = this.px(tile.tile_x * side);
      const top = this.py((tile.tile_y + 1) * side);
      const size = side * this.scale;
      if (left > this.width || top > this.height || left + size < 0 || top + size < 0) continue;
      this.context.drawImage(this.tileImage(entry), left, top, size + 0.6, size + 0.6);
    }
  }

  drawGrid() {
    const step = [1, 2, 5, 10, 20, 50].find((metres) => metres * this.scale >= 60) ?? 100;
    const c = this.context;
    c.strokeStyle = "#00000014";
    c.lineWidth = 1;
    c.beginPath();
    const low = this.toMap(0, this.height);
    const high = this.toMap(this.width, 0);
    for (let x = Math.ceil(low.x / step) * step; x < high.x; x += step) { c.moveTo(this.px(x), 0); c.lineTo(this.px(x), this.height); }
    for (let y = Math.ceil(low.y / step) * step; y < high.y; y += step) { c.moveTo(0, this.py(y)); c.lineTo(this.width, this.py(y)); }
        c.stroke();
    this.step = step;
    c.fillStyle = "#5a646e";
    c.font = "10px system-ui, sans-serif";
    c.textAlign = "left";
    for (let x = Math.ceil(low.x / step) * step; x < high.x; x += step) c.fillText(`x ${x}`, this.px(x) + 2, this.height - 3);
    for (let y = Math.ceil(low.y / step) * step; y < high.y; y += step) c.fillText(`y ${y}`, 2, this.py(y) - 2);
  }

  line(points, colour, width, dash = []) {
    if (points.length < 2) return;
    const c = this.context;
    c.strokeStyle = colour;
    c.lineWidth = width;
    c.setLineDash(dash);
    c.beginPath();
    points.forEach(([x, y], i) => (i === 0 ? c.moveTo(this.px(x), this.py(y)) : c.lineTo(this.px(x), this.py(y))));
    c.stroke();
    c.setLineDash([]);
  }

  drawWay() {
    const now = this.state.now();
    const way = [];
    for (const [time, x, y] of this.state.history.way) {
      if (time > now) break;
      way.push([x, y]);
    }
    this.line(way, COLOUR.way, 1.5);
  }

  drawTree() {
    const tree = this.state.get("PLAN_TREE")?.message;
    if (!tree) return;
    const c = this.context;
    c.strokeStyle = COLOUR.tree + "88";
    c.lineWidth = 1;
    c.beginPath();
    for (let i = 0; i < tree.num_nodes; ++i) {
      const parent = tree.parent[i];
      if (parent < 0) continue;
      c.moveTo(this.px(tree.node_pose[3 * parent]), this.py(tree.node_pose[3 * parent + 1]));
      c.lineTo(this.px(tree.node_pose[3 * i]), this.py(tree.node_pose[3 * i + 1]));
    }
    c.stroke();
  }

  drawPlan() {
    const plan = this.state.get("PLAN")?.message;
    if (!plan || plan.num_patterns === 0) return;
    const c = this.context;
    const points = [];
    
    for (let i = 0; i < plan.num_patterns; ++i) {
      const [x, y, yaw] = plan.pose.slice(3 * i, 3 * i + 3).map(number);
      this.drawDoubt(x, y, plan.covariance.slice(6 * i, 6 * i + 6).map(number));
      const pattern = this.state.pattern(plan.pattern_id[i]);
      // Drawn from its end backwards: only the end of the running one is known.
      if (pattern) points.push(...this.curve(pattern, { x, y, yaw }));
      else points.push([x, y]);
      
    }
    this.line(points, COLOUR.plan, 3);
    c.fillStyle = COLOUR.plan;
    for (let i = 0; i < plan.num_patterns; ++i) {
      c.beginPath();
      c.arc(this.px(number(plan.pose[3 * i])), this.py(number(plan.pose[3 * i + 1])), 3, 0, 7);
      c.fill();
    }
  }

  

  // A pattern's path in map that ends at a pose.
  curve(pattern, end) {
    const flat = pattern.trajectory.map(number);
    const count = flat.length / 3;
    const last = { x: flat[3 * count - 3], y: flat[3 * count - 2], yaw: flat[3 * count - 1] };
    const yaw = end.yaw - last.yaw;
    const start = { x: end.x - (Math.cos(yaw) * last.x - Math.sin(yaw) * last.y),
      y: end.y - (Math.sin(yaw) * last.x + Math.cos(yaw) * last.y), yaw };
    return this.path(pattern, start);
  }

  path(pattern, start) {
    const flat = pattern.trajectory.map(number);
    const points = [[start.x, start.y]];
    for (let i = 0; i + 2 < flat.length; i += 3) {
      const at = compose(start, { x: flat[i], y: flat[i + 1], yaw: flat[i + 2] });
      points.push([at.x, at.y]);
    }
    return points;
  }

  drawDoubt(x, y, [xx, xy, , yy]) {
    if (!Number.isFinite(xx + xy + yy)) return;
    const mean = (xx + yy) / 2;
    const spread = Math.hypot((xx - yy) / 2, xy);
    const c = this.context;
    c.fillStyle = COLOUR.plan + "2e";
    c.beginPath();
    c.ellipse(this.px(x), this.py(y), 2 * Math.sqrt(Math.max(0, mean + spread)) * this.scale,
      2 * Math.sqrt(Math.max(0, mean - spread)) * this.scale, -0.5 * Math.atan2(2 * xy, xx - yy), 0, 7);
    c.fill();
  }

  // The running pattern, from its start.
  drawRun() {
    const { run } = this.state;
    const pattern = run && run.time <= this.state.now() && this.state.pattern(run.pattern);
    if (pattern && this.state.get("PROGRAM")) this.line(this.path(pattern, run.start), "#000000", 2, [5, 4]);
  }

  drawScan() {
    const scan = this.state.get("SCAN")?.message;
    const pose = this.state.pose();
    if (!scan || !pose) return;
    const c = this.context;
    c.fillStyle = COLOUR.scan + "99";
    const [sx, sy] = scan.sensor_position.map(number);
    const q = scan.sensor_orientation.map(number);
    const turn = Math.atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] * q[2] + q[3] * q[3]));
    const sensor = compose(pose, { x: sx, y: sy, yaw: turn });
    const first = number(scan.angle_first);
    const step = number(scan.angle_step);
    for (let i = 0; i < scan.num_beams; ++i) {
      const range = scan.ranges[i];
      if (typeof range !== "number" || range < scan.range_min || range > scan.range_max) continue;
      const angle = sensor.yaw + first + i * step;
      c.fillRect(this.px(sensor.x + range * Math.cos(angle)) - 1, this.py(sensor.y + range * Math.sin(angle)) - 1, 2, 2);
    }
  }

  drawGoal() {
    const goal = this.state.get("GOAL")?.message;
    const plan = this.state.get("PLAN")?.message;
    if (goal && goal.goal_id !== 0 && plan && plan.goal_id === goal.goal_id) {
      const [x, y, yaw] = goal.goal_pose.map(number);
      this.target(x, y, known(goal.position_tolerance) ? number(goal.position_tolerance) : 0.5,
        number(goal.yaw_tolerance) < 3 ? yaw : null);
    }
    if (this.wanted) this.target(this.wanted.x, this.wanted.y, 0.6, this.wanted.yaw);
  }

  target(x, y, radius, yaw) {
    const c = this.context;
    c.strokeStyle = COLOUR.goal;
    c.fillStyle = COLOUR.goal + "40";
    c.lineWidth = 3;
    c.beginPath();
    c.arc(this.px(x), this.py(y), Math.max(6, radius * this.scale), 0, 7);
    c.fill();
    c.stroke();
    if (yaw === null || yaw === undefined) return;
    this.line([[x, y], [x + 1.2 * radius * Math.cos(yaw), y + 1.2 * radius * Math.sin(yaw)]], COLOUR.goal, 4);
  }

  drawFences() {
    const c = this.context;
    for (const fence of this.state.standingFences()) {
      const flat = fence.corners.map(number);
      c.beginPath();
      for (let i = 0; i < flat.length; i += 2) c.lineTo(this.px(flat[i]), this.py(flat[i + 1]));
      c.closePath();
      c.strokeStyle = COLOUR.fence;
      c.lineWidth = 2;
      c.setLineDash([8, 4]);
      c.stroke();
      c.setLineDash([]);
      if (fence.fence_kind === 2) { c.fillStyle = COLOUR.fence + "30"; c.fill(); }
    }
    if (this.draft.length > 0) this.line([...this.draft, this.draft[0]].map(({ x, y }) => [x, y]), COLOUR.fence, 2, [8, 4]);
    c.fillStyle = COLOUR.fence;
    for (const { x, y } of this.draft) c.fillRect(this.px(x) - 3, this.py(y) - 3, 6, 6);
  }

  drawRobot(pose, stale) {
    const c = this.context;
    const { front, rear, half_width: half } = this.state.outline;
    c.save();
    c.translate(this.px(pose.x), this.py(pose.y));
    c.rotate(-pose.yaw);
    c.scale(this.scale, this.scale);
    c.fillStyle = stale ? "#8a949e" : COLOUR.robot;
    c.globalAlpha = 0.85;
    c.fillRect(-rear, -half, front + rear, 2 * half);
    c.globalAlpha = 1;
    c.fillStyle = "#fff";
    c.beginPath();
    c.moveTo(front * 0.9, 0);
    c.lineTo(front * 0.1, half * 0.7);
    c.lineTo(front * 0.1, -half * 0.7);
    c.fill();
    c.restore();
  }
}
