// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// A page, without pictures, that drives the robot to and fro: node operator.mjs MODULES HTTP-URL SECONDS, or until
// SIGTERM. Prints "is armed", and at the end how often the robot was disarmed and the longest gap between messages.
import { createRequire } from "node:module";
const require = createRequire(`${process.argv[2]}/x.js`);
const { FoxgloveClient } = require("@foxglove/ws-protocol");
const { WebSocket } = require("ws");
const url = new URL(process.argv[3]);
let end = performance.now() + 1000 * Number(process.argv[4]);
process.on("SIGTERM", () => { end = 0; });
const fail = (words) => { console.error(words); process.exit(1); };

const socket = new WebSocket(url.href.replace("http", "ws"), [FoxgloveClient.SUPPORTED_SUBPROTOCOL], { origin: url.origin });
const client = new FoxgloveClient({ ws: socket });
let motor = null, seen = 0, last = 0, longest = 0, heard = 0, disarmed = 0, was = false;
const reasons = new Set();
client.on("error", (error) => fail(String(error)));
client.on("close", () => fail("the operator's page was closed"));
client.on("advertise", (channels) => client.subscribe(channels.find(({ topic }) => topic === "MOTOR").id));
client.on("message", ({ timestamp, data }) => {
  motor = JSON.parse(new TextDecoder().decode(data));
  seen = Number(timestamp / 1000n);
  const now = performance.now();
  const armed = [1, 2, 3].includes(motor.bridge_state);
  if (was) longest = Math.max(longest, now - last);
  if (was && !armed) { ++disarmed; reasons.add(motor.state_reason); }
  if (armed && !was) console.log("is armed");
  was = armed;
  last = now;
  ++heard;
});
// The last message of the console.
let told = "";
client.on("status", ({ message }) => { told = message; });
client.on("serverInfo", () => {
  const channel = client.advertise({ topic: "view/command", encoding: "json", schemaName: "" });
  const say = (message) => client.sendMessage(channel, new TextEncoder().encode(JSON.stringify({ ...message, seen })));
  let asked = -1e9, x = -20;
  setInterval(() => {
    if (performance.now() > end) {
      console.log(`${heard} MOTOR, longest pause ${longest.toFixed(0)} ms, disarmed ${disarmed} times: ${[...reasons].join(" | ")}`);
      console.log(`told last: ${told}; motors: ${motor?.state_reason}`);
      console.log("1 passed, 0 failed");
      process.exit(0);
    }
    if (motor === null) return;
    say({ op: "alive" });
    if (performance.now() - asked < 4000) return;
    if (motor.bridge_state === 0 || motor.bridge_state === 4) { asked = performance.now(); say({ op: "arm" }); }
    if (motor.bridge_state === 1) { asked = performance.now(); say({ op: "goal", x: x = -x, y: 0 }); }
  }, 200);
});
