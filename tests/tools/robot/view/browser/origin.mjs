// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Another site's page in the same browser, and a foreign host name for this machine: node origin.mjs MODULES HTTP-URL
// URL-WITH-TOKEN
import { createRequire } from "node:module";
import http from "node:http";
const require = createRequire(`${process.argv[2]}/x.js`);
const { WebSocket } = require("ws");
const url = new URL(process.argv[3]);
const asking = new URL(process.argv[4]);
const fail = (words) => { console.error(words); process.exit(1); };
setTimeout(() => fail("out of time"), 10000);

const get = (headers) => new Promise((done) => http.get({ host: url.hostname, port: url.port, path: "/", headers },
  (answer) => { answer.resume(); done(answer); }));
const ours = await get({ Host: url.host });
if (ours.statusCode !== 200 || ours.headers["x-frame-options"] !== "DENY") fail("the page may be framed");
if (!ours.headers["content-security-policy"].includes("frame-ancestors 'none'")) fail("the page may be framed");
if ((await get({ Host: "evil.example" })).statusCode !== 403) fail("another name for this machine is let in");
// Whatever host the forwarded headers claim.
if ((await get({ Host: "evil.example", "X-Forwarded-Host": url.host })).statusCode !== 403) fail("a forwarded name is believed");

const open = (to, origin) => new Promise((done) => {
  const socket = new WebSocket(to.href.replace("http", "ws"), ["foxglove.websocket.v1"], origin ? { origin } : {});
  const heard = [];
  socket.on("message", (data, binary) => { if (!binary) heard.push(JSON.parse(data.toString())); });
  socket.on("message", () => heard.length === 2 && done({ socket, heard }));
  socket.on("error", () => done(null));
});
for (const origin of ["http://evil.example", "null", "file://", `http://${url.hostname}:1`, `http://${url.host}.evil.example`])
  if (await open(url, origin)) fail(`a page from ${origin} may listen`);
if (!(await open(url))) fail("a program may not listen");
if (!(await open(url, url.origin)).heard[0].capabilities.includes("clientPublish")) fail("our own page may not publish");
// With the token any origin may view, but not operate.
const stranger = await open(asking, "http://evil.example");
if (!stranger) fail("a page from elsewhere that knows the token may not look");
if (stranger.heard[0].capabilities.includes("clientPublish")) fail("a stranger's page may publish");
stranger.socket.send(JSON.stringify({ op: "advertise", channels: [{ id: 1, topic: "view/command", encoding: "json", schemaName: "" }] }));
stranger.socket.send(Buffer.concat([Buffer.from([1, 1, 0, 0, 0]), Buffer.from('{"op":"arm","seen":0}')]));
await new Promise((done) => setTimeout(done, 500));
const told = stranger.heard.find((message) => message.op === "status" && message.level === 1);
if (!told || !told.message.includes("not operate")) fail("a stranger's command was not refused");
console.log("1 passed, 0 failed");
process.exit(0);
