// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The cards next to the map: texts and numbers.
import { number, known, motorWord, planWord, mayDrive } from "./state.js";
import { surfaceName } from "./charts.js";

const escape = (text) => String(text).replace(/[&<>"]/g, (letter) => `&#${letter.charCodeAt(0)};`);
const fixed = (value, digits, unit = "") => (known(value) ? `${number(value).toFixed(digits)}${unit}` : "&ndash;");
const percent = (share) => `${(100 * number(share)).toPrecision(2)} %`;
const degrees = (radians) => (number(radians) * 180) / Math.PI;

function put(id, html) {
  const body = document.querySelector(`#${id} .body`);
  if (body.dataset.html === html) return;
  body.dataset.html = html;
  body.innerHTML = html;
}

export function setAge(id, seconds, longest) {
  const card = document.getElementById(id);
  const stale = seconds === null || seconds > longest;
  card.classList.toggle("stale", stale);
    const words = seconds === null ? "never received" : seconds < 1 ? "" : `${seconds < 100 ? seconds.toFixed(1) : Math.round(seconds)} s old`;
  const age = card.querySelector(".age");
  if (age.textContent !== words) age.textContent = words;
}

export function headline(state) {
  const motor = state.get("MOTOR")?.message;
  const plan = state.get("PLAN")?.message;
  if (!motor && !plan) return "waiting for the robot";
  if (motor && !mayDrive(motor.bridge_state)) return `${motorWord(motor.bridge_state)}: ${motor.state_reason}`;
  if (!plan) return motorWord(motor.bridge_state);
  const words = planWord(plan.plan_status);
  return plan.reason ? `${words}: ${plan.reason}` : words;
}

export function showRobot(state, clock) {
  const motor = state.get("MOTOR");
  const plan = state.get("PLAN");
  const ins = state.get("INS");
  const goal = state.get("GOAL")?.message;
  const pose = state.pose();
  const run = state.run && state.pattern(state.run.pattern);
  const rows = [];
  if (motor) rows.push(["motors", `<b>${motorWord(motor.message.bridge_state)}</b> <span class="why">${motor.message.bridge_state === 2 ? "" : escape(motor.message.state_reason)}</span>`]);
  if (plan) rows.push(["planner", `<b>${planWord(plan.message.plan_status)}</b> <span class="why">${escape(plan.message.reason)}</span>`]);
  if (pose) rows.push(["at", `x ${fixed(pose.x, 2)} m, y ${fixed(pose.y, 2)} m, ${fixed(degrees(pose.yaw), 0)}&deg;`]);
  if (ins) {
    rows.push(["speed", `${fixed(ins.message.velocity[0], 2, " m/s")}, turns ${fixed(degrees(ins.message.rate[2]), 0)}&deg;/s`]);
    const std = Math.max(number(ins.message.position_std[0]), number(ins.message.position_std[1]));
    rows.push(["position &plusmn;", fixed(std, 2, " m") + (ins.message.ins_status & 64 ? " (filled in by scan matching)" : "")]);
  }
  if (plan && plan.message.goal_id !== 0 && goal && pose) {
    const distance = Math.hypot(number(goal.goal_pose[0]) - pose.x, number(goal.goal_pose[1]) - pose.y);
    rows.push(["goal", `${fixed(distance, 1)} m away, ${fixed(plan.message.time_to_go, 0)} s to go`]);
  }
  if (plan && known(plan.message.risk)) {
    const perMetre = known(plan.message.risk_per_metre) ? `, ${percent(plan.message.risk_per_metre)} a metre` : "";
    rows.push(["risk", `at most ${percent(plan.message.risk)} that the plan touches something${perMetre}`]);
  }
  if (run) rows.push(["pattern", escape(run.name)]);
  put("robot", `<dl>${rows.map(([name, value]) => `<dt>${name}</dt><dd>${value}</dd>`).join("")}</dl>`);
  setAge("robot", motor ? state.age(motor, clock) : null, 0.5);
}

export function showDrive(state, clock) {
  const motor = state.get("MOTOR");
  if (motor) {
    const m = motor.message;
    const bars = m.command.slice(0, 8).map((value, i) => {
      if (!known(value)) return "";
      const kind = m.channel_kind[i];
      const most = kind === 1 ? 1 : kind === 2 ? 2 : 0.7;
      const share = Math.max(-1, Math.min(1, number(value) / most));
      const unit = kind === 2 ? " m/s" : kind === 3 ? " rad" : "";
      const current = known(m.current[i]) ? `, ${number(m.current[i]).toFixed(1)} A` : "";
      const measured = known(m.measured[i]) ? `, measured ${number(m.measured[i]).toFixed(2)}` : "";
      const name = kind === 3 ? "steering" : kind === 0 ? `channel ${i + 1}` : ["left", "right"][i] ?? `channel ${i + 1}`;
      return `<div>${name} ${number(value).toFixed(2)}${unit}${current}${measured}</div><div class="bar"><i style="left:${share < 0 ? 50 + 50 * share : 50}%;width:${50 * Math.abs(share)}%"></i><b></b></div>`;
    });
    const battery = known(m.battery_voltage) ? `battery ${number(m.battery_voltage).toFixed(1)} V` : "battery not measured";
    put("drive", `${bars.join("")}<div>${battery}${m.device_fault ? ` <span class="why">controller's flags 0x${m.device_fault.toString(16)}</span>` : ""}</div>`);
  }
  setAge("drive", motor ? state.age(motor, clock) : null, 0.5);
}

export function showLearned(state, clock) {
  const learning = state.get("LEARNING");
  if (learning) {
    const l = learning.message;
    const result = l.accepted
      ? `ended ${fixed(l.error_position, 2)} m and ${fixed(degrees(l.error_yaw), 1)}&deg; from its prediction; the new set would have been ${fixed(l.error_position_after, 2)} m off`
      : `not learned from: ${escape(l.gate_reason)}`;
    put("learned", `<div class="big">${escape(l.learned_pattern_name)}</div><div>${result}</div>` +
      (l.change_reason ? `<div class="why">ground: ${escape(l.change_reason)}</div>` : "") +
      `<div class="why">pattern set ${l.result_version}; ${surfaceName(l.surface)}${known(l.ground_changed) && l.ground_changed > 0.5 ? ", the ground changed" : ""}</div>`);
  } else put("learned", "<div class=\"why\">nothing yet</div>");
  // LEARNING comes after each pattern, so an old message is still valid.
  setAge("learned", learning ? state.age(learning, clock) : null, 1e9);
}

export function showHealth(state, clock) {
  const marks = [["ok", "\u2713"], ["degraded", "!"], ["failed", "\u2717"]];
  const rows = [...state.health].filter(([, entry]) => entry.time <= state.now()).sort(([a], [b]) => (a < b ? -1 : 1)).map(([process, entry]) => {
    const age = state.age(entry, clock);
    const [name, sign] = marks[entry.message.health_state] ?? marks[2];
    const old = age > 2.5;
    const words = old ? `silent for ${age.toFixed(0)} s` : entry.message.health_reason;
    return `<div class="process ${name}${old ? " old" : ""}"><span class="mark">${old ? "?" : sign}</span><span>${escape(process)}</span><small>${escape(words)}</small></div>`;
  });
  const doubt = state.player?.doubt;
  if (doubt) rows.unshift(`<div class="process failed"><span class="mark">!</span><span>tread-view</span><small>${escape(doubt)}</small></div>`);
  put("health", rows.join("") || "<div class=\"why\">none heard</div>");
}

export function showEvents(state, begin) {
  const now = state.now();
  const shown = state.history.events.filter(([time]) => time <= now || !state.live).slice(-400).reverse();
  const nearest = state.live ? -1 : shown.findIndex(([time]) => time <= now);
  put("events", shown.slice(0, 120 + Math.max(0, nearest)).map(([time, severity, source, words], i) =>
    `<div class="event s${severity}${i === nearest ? " now" : ""}" data-time="${time}"><time>${((time - begin) / 1e6).toFixed(1)} s</time><span><b>${escape(source)}</b> ${escape(words)}</span></div>`).join("") || "<div class=\"why\">nothing yet</div>");
  // For a log the list follows the playback time.
  const row = document.querySelector("#events .event.now");
  const list = document.querySelector("#events .body");
  if (row && list.dataset.at !== row.dataset.time) {
    list.dataset.at = row.dataset.time;
    list.scrollTop = row.offsetTop - list.offsetTop - 30;
  }
}
