// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Load on the robot when 200 raw clients and a page of another origin request as much as possible:
// node flood.mjs MODULES HTTP-URL SECONDS [NICE]
import { createRequire } from "node:module";
import { existsSync, readdirSync, readFileSync } from "node:fs";
import http from "node:http";
import os from "node:os";
const require = createRequire(`${process.argv[2]}/x.js`);
const { WebSocket } = require("ws");
const { chromium } = require("playwright-core");
const url = new URL(process.argv[3]);
const ws = url.href.replace("http", "ws");
const milliseconds = 1000 * Number(process.argv[4]);
let end = Infinity;
const fail = (words) => { console.error(words); process.exit(1); };
// The clients would run on other machines, so their CPU time should not affect the measurement: low priority, which their
// browser inherits as long as it may not raise it.
os.setPriority(Number(process.argv[5] ?? 10));

/// CPU time [s] of this process and its children so far.
function computed() {
  const all = readdirSync("/proc").filter((name) => /^\d+$/.test(name)).flatMap((name) => {
    try {
      const words = readFileSync(`/proc/${name}/stat`, "latin1").replace(/^.*\) /, "").split(" ");
      return [{ pid: Number(name), parent: Number(words[1]), seconds: (Number(words[11]) + Number(words[12])) / 100 }];
    } catch { return []; }
  });
  const of = (pid) => all.filter(({ parent }) => parent === pid).reduce((sum, { pid, seconds }) => sum + seconds + of(pid), 0);
  return process.cpuUsage().user / 1e6 + process.cpuUsage().system / 1e6 + of(process.pid);
}

// A page of another origin opens sockets as fast as possible, and counts those that succeed.
const stranger = http.createServer((_, answer) => answer.end(`<script>
  window.opened = 0; window.tried = 0;
  const knock = () => { ++window.tried; const socket = new WebSocket("${ws}", ["foxglove.websocket.v1"]);
    socket.onopen = () => ++window.opened; socket.onclose = () => setTimeout(knock, 20); };
  for (let i = 0; i < 20; ++i) knock();
  setInterval(() => fetch("${url.href}", { mode: "no-cors" }).catch(() => {}), 50);
</script>`)).listen(0, "127.0.0.1");
await new Promise((done) => stranger.on("listening", done));
const executablePath = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(existsSync);
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--disable-gpu"] });
const page = await browser.newPage();
await page.goto(`http://127.0.0.1:${stranger.address().port}/`);

let opened = 0, closed = 0, requests = 0, bytes = 0;
const all = (first) => JSON.stringify({ op: "subscribe", subscriptions: Array.from({ length: 30 }, (_, i) => ({ id: first + i, channelId: i + 1 })) });
const none = (first) => JSON.stringify({ op: "unsubscribe", subscriptionIds: Array.from({ length: 30 }, (_, i) => first + i) });
function knock(kind) {
  if (performance.now() > end) return;
  const socket = new WebSocket(ws, ["foxglove.websocket.v1"]);
  let timer = null;
  socket.on("error", () => {});
  socket.on("message", (data) => { bytes += data.length; });
  socket.on("open", () => {
    ++opened;
    let first = 1;
    // Some never read the replies.
    if (kind % 4 === 0) socket._socket.pause();
    timer = setInterval(() => {
      if (socket.readyState !== WebSocket.OPEN) return;
      ++requests;
      // The same request again; the same after closing; a large one; all as fast as possible.
      if (kind % 4 === 2) socket.send(none(first));
      if (kind % 4 === 3 && requests % 50 === 0) socket.send("x".repeat(1 << 20));
      socket.send(all(first += 30));
    }, kind % 4 === 1 ? 1 : 20);
  });
  socket.on("close", () => { ++closed; clearInterval(timer); setTimeout(() => knock(kind), 50); });
}
for (let kind = 0; kind < 200; ++kind) knock(kind);
// From the moment when all connections are in use.
const inTime = performance.now() + 30000;
while (opened < 20 && performance.now() < inTime) await new Promise((done) => setTimeout(done, 50));
end = performance.now() + milliseconds;
const before = computed();
await new Promise((done) => setTimeout(done, end - performance.now()));
const [tried, through] = await page.evaluate(() => [window.tried, window.opened]);
const share = (computed() - before) / milliseconds * 1e5;
await browser.close();
console.log(`flood and its browser: ${share.toFixed(0)} % of a core`);
console.log(`page of another origin: ${tried} sockets tried, ${through} opened; raw clients: ${opened} opened, ${closed} closed, ${requests} requests, ${(bytes / 1e6).toFixed(0)} MB got`);
if (through > 0 || tried < 20) fail("a page of another origin got through, or did not try");
if (opened < 20 || requests < 50) fail("the raw clients did not get in: nothing was tried");
console.log("1 passed, 0 failed");
process.exit(0);
