// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The page in headless Chromium behind a proxy with TLS, under a path: node proxy.mjs MODULES URL PORT PEM keep|rewrite ours|foreign
// keep: the proxy forwards the requested host name and the path; rewrite: neither, like nginx by default.
// foreign: tread-view is not configured for the proxy.
import { createRequire } from "node:module";
import { existsSync, readFileSync } from "node:fs";
import http from "node:http";
import https from "node:https";
import net from "node:net";
const [, , modules, to, port, pem, how, whose] = process.argv;
const require = createRequire(`${modules}/x.js`);
const { chromium } = require("playwright-core");
const upstream = new URL(to);
const fail = (words) => { console.error(words); process.exit(1); };
setTimeout(() => fail("out of time"), 60000);

const text = readFileSync(pem);
const asked = ({ url, headers }) => how === "keep" ? { path: url, headers }
  : { path: url.replace(/^\/robot/, ""), headers: { ...headers, host: upstream.host } };
const proxy = https.createServer({ cert: text, key: text }, (request, answer) => {
  http.get({ host: upstream.hostname, port: upstream.port, ...asked(request) }, (page) => {
    answer.writeHead(page.statusCode, page.headers);
    page.pipe(answer);
  });
});
proxy.on("upgrade", (request, socket) => {
  const { path, headers } = asked(request);
  const line = net.connect(upstream.port, upstream.hostname, () => {
    line.write(`GET ${path} HTTP/1.1\r\n${Object.entries(headers).map(([name, value]) => `${name}: ${value}\r\n`).join("")}\r\n`);
    line.pipe(socket).pipe(line);
  });
  for (const end of [line, socket]) end.on("error", () => { line.destroy(); socket.destroy(); });
});
await new Promise((done) => proxy.listen(port, "127.0.0.1", done));

const executablePath = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(existsSync);
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--disable-gpu"] });
const page = await browser.newPage({ ignoreHTTPSErrors: true });
await page.goto(`https://127.0.0.1:${port}/robot/${upstream.search}`);
const mode = async () => page.locator("#mode").innerText();
for (let i = 0; i < 200 && (await mode()) !== "LIVE"; ++i) await page.waitForTimeout(50);
if ((await mode()) !== "LIVE") fail(`the page says ${await mode()}`);
const operates = !(await page.locator("#estop").isHidden());
await browser.close();
if (operates !== (whose === "ours")) fail(operates ? "a page from a proxy that nobody named may operate" : "our page may not operate");
console.log("1 passed, 0 failed");
process.exit(0);
