// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The protocol's reference client with tread-view: node foxglove.mjs MODULES URL
import { createRequire } from "node:module";
const require = createRequire(`${process.argv[2]}/x.js`);
const { FoxgloveClient } = require("@foxglove/ws-protocol");
const { WebSocket } = require("ws");

const wanted = ["INS", "MAP", "scene/tf", "scene/map", "scene/plan", "view/player"];
const got = new Map();
const fail = (words) => { console.error(words); process.exit(1); };
setTimeout(() => fail(`out of time; got ${[...got.keys()]}`), 15000);
const client = new FoxgloveClient({ ws: new WebSocket(process.argv[3], [FoxgloveClient.SUPPORTED_SUBPROTOCOL]) });
const topics = new Map();
client.on("error", (error) => fail(String(error)));
client.on("advertise", (channels) => {
  if (channels.length < 28) fail(`only ${channels.length} channels`);
  for (const channel of channels) {
    JSON.parse(channel.schema);
    if (wanted.includes(channel.topic)) topics.set(client.subscribe(channel.id), channel.topic);
  }
  const control = client.advertise({ topic: "view/control", encoding: "json", schemaName: "" });
  const say = (message) => client.sendMessage(control, new TextEncoder().encode(JSON.stringify(message)));
  setTimeout(() => say({ op: "play", speed: 4 }), 200);
});
client.on("message", ({ subscriptionId, timestamp, data }) => {
  const topic = topics.get(subscriptionId);
  if (timestamp <= 0n) fail("a message without a time");
  got.set(topic, JSON.parse(new TextDecoder().decode(data)));
  if (wanted.every((name) => got.has(name))) {
    if (got.get("scene/tf").child_frame_id !== "body") fail("no transform");
    console.log("1 passed, 0 failed");
    process.exit(0);
  }
});
