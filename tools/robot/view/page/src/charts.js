// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Prediction error over time; present and previous patterns.
import { number } from "./state.js";

const SURFACE = ["#1c2126", "#e69f00", "#56b4e9", "#009e73", "#cc79a7", "#0072b2", "#d55e00", "#8a949e"];
const MARKS = ["circle", "square", "triangle", "diamond"];

function prepare(canvas) {
  const ratio = window.devicePixelRatio || 1;
  const width = canvas.clientWidth;
  const height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  context.font = "11px system-ui, sans-serif";
  return { context, width, height };
}

// A surface has a shape in addition to its colour, for people who cannot distinguish the colours.
function mark(c, shape, x, y, r) {
  c.beginPath();
  if (shape === "circle") c.arc(x, y, r, 0, 7);
  else if (shape === "square") c.rect(x - r, y - r, 2 * r, 2 * r);
  else if (shape === "triangle") { c.moveTo(x, y - r * 1.2); c.lineTo(x + r * 1.1, y + r); c.lineTo(x - r * 1.1, y + r); }
  else { c.moveTo(x, y - r * 1.3); c.lineTo(x + r * 1.3, y); c.lineTo(x, y + r * 1.3); c.lineTo(x - r * 1.3, y); }
  c.fill();
}

export function surfaceName(surface) {
  return surface === 0 ? "shipped or unknown ground" : `ground ${surface}`;
}

export function drawErrors(canvas, state, span) {
  const { context: c, width, height } = prepare(canvas);
  const left = 46, right = width - 10, top = 16, bottom = height - 16;
  const [begin, end] = span;
  const patterns = state.history.patterns.filter(([time, , accepted, position]) => accepted && position !== null && time >= begin && time <= end);
  const highest = Math.max(0.1, ...patterns.map(([, , , position]) => position));
  const x = (time) => left + ((time - begin) / Math.max(1, end - begin)) * (right - left);
  const y = (error) => bottom - (error / highest) * (bottom - top);
  c.fillStyle = "#6b7680";
  c.textAlign = "left";
  c.fillText("distance of each pattern's end from its prediction [m]; bar: change of ground", left, 10);
  // Legend: ground of each sign.
  const surfaces = [...new Set(patterns.map(([, , , , , surface]) => surface))].sort((a, b) => a - b);
  let at = left + 560;
  for (const surface of surfaces) {
    c.fillStyle = SURFACE[surface % SURFACE.length];
    mark(c, MARKS[surface % MARKS.length], at, 6, 3.2);
    c.fillStyle = "#6b7680";
    c.fillText(surfaceName(surface), at + 7, 10);
    at += 22 + c.measureText(surfaceName(surface)).width;
  }
  c.textAlign = "right";
  for (const value of [0, highest / 2, highest]) {
    c.fillText(value.toFixed(2), left - 4, y(value) + 4);
    c.strokeStyle = "#e3e7ea";
    c.beginPath();
    c.moveTo(left, y(value));
    c.lineTo(right, y(value));
    c.stroke();
  }
  c.textAlign = "center";
  const seconds = (end - begin) / 1e6;
  const step = [1, 2, 5, 10, 30, 60, 120, 300, 600, 1800].find((candidate) => seconds / candidate <= 12) ?? 3600;
  for (let t = 0; t <= seconds; t += step) c.fillText(`${t} s`, x(begin + t * 1e6), height - 3);
  for (const [time, , , position, , surface, changed] of patterns) {
    if (changed !== null && changed > 0.5) { c.fillStyle = "#e69f0055"; c.fillRect(x(time) - 1.5, top, 3, bottom - top); }
        c.fillStyle = SURFACE[surface % SURFACE.length];
    // Later points of a log are faint.
    c.globalAlpha = !state.live && state.player && time > state.player.now ? 0.35 : 1;
    mark(c, MARKS[surface % MARKS.length], x(time), y(position), 3.2);
    c.globalAlpha = 1;
  }
  if (!state.live && state.player) {
    c.strokeStyle = "#b3261e";
    c.lineWidth = 1.5;
    c.beginPath();
    c.moveTo(x(state.player.now), top - 4);
    c.lineTo(x(state.player.now), bottom);
    c.stroke();
    c.lineWidth = 1;
  }
  return (px) => begin + ((px - left) / (right - left)) * (end - begin);
}

export function drawPatterns(canvas, state, learned) {
  const { context: c, width, height } = prepare(canvas);
  const all = [...state.patterns.values()];
  if (all.length === 0) return;
  let low = { x: 0, y: 0 }, high = { x: 0, y: 0 };
  for (const { trajectory } of all)
    for (let i = 0; i + 2 < trajectory.length; i += 3) {
      const px = number(trajectory[i]), py = number(trajectory[i + 1]);
      low = { x: Math.min(low.x, px), y: Math.min(low.y, py) };
      high = { x: Math.max(high.x, px), y: Math.max(high.y, py) };
    }
  // Forward is up.
  const scale = Math.min((height - 26) / Math.max(0.5, high.x - low.x), (width - 16) / Math.max(0.5, high.y - low.y));
  const px = (y) => width / 2 - (y - (low.y + high.y) / 2) * scale;
  const py = (x) => height - 18 - (x - low.x) * scale;
  const stroke = (pattern, colour, lineWidth, dash) => {
    c.strokeStyle = colour;
    c.lineWidth = lineWidth;
    c.setLineDash(dash);
    c.beginPath();
    c.moveTo(px(0), py(0));
    for (let i = 0; i + 2 < pattern.trajectory.length; i += 3)
      c.lineTo(px(number(pattern.trajectory[i + 1])), py(number(pattern.trajectory[i])));
    c.stroke();
    c.setLineDash([]);
  };
  for (const [part, pattern] of state.patterns) {
    const before = state.before.get(part);
    if (before) stroke(before, "#b6bec5", 1, [3, 3]);
    stroke(pattern, "#56b4e9", 1.2, []);
  }
  const last = all.find((pattern) => pattern.id === learned);
  if (last) stroke(last, "#0072b2", 3, []);
    c.strokeStyle = "#5a646e";
  c.lineWidth = 1.5;
  c.beginPath();
  c.moveTo(8, height - 22);
  c.lineTo(8 + scale, height - 22);
  c.stroke();
  c.fillStyle = "#6b7680";
  c.textAlign = "left";
  c.fillText("1 m", 8, height - 26);
  c.textAlign = "center";
  c.fillText("patterns now; dashed: previous set; thick: learned last", width / 2, height - 4);
}
