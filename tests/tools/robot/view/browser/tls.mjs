// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Access from the network to a page that listens to it: node tls.mjs MODULES PORT TOKEN FINGERPRINT
import { createRequire } from "node:module";
import http from "node:http";
import https from "node:https";
import tls from "node:tls";
const [, , modules, port, token, fingerprint] = process.argv;
const require = createRequire(`${modules}/x.js`);
const { WebSocket } = require("ws");
const fail = (words) => { console.error(words); process.exit(1); };
setTimeout(() => fail("out of time"), 15000);

const status = (client, path) => new Promise((done) => client.get({ host: "127.0.0.1", port, path, rejectUnauthorized: false },
  (answer) => { answer.resume(); done(answer.statusCode); }).on("error", () => done(0)));
if ((await status(https, `/?token=${token}`)) !== 200) fail("the page is not there by TLS");
if ((await status(https, "/")) !== 403) fail("the token is not asked");
if ((await status(http, `/?token=${token}`)) === 200) fail("the page, and its token, go in clear");
const peer = await new Promise((done) => {
  const line = tls.connect({ host: "127.0.0.1", port, rejectUnauthorized: false }, () => done(line.getPeerCertificate()));
});
if (peer.fingerprint256 !== fingerprint) fail(`the certificate is ${peer.fingerprint256}, told was ${fingerprint}`);
// A client with the certificate's fingerprint rejects any other certificate.
const socket = new WebSocket(`wss://127.0.0.1:${port}/?token=${token}`, ["foxglove.websocket.v1"], { rejectUnauthorized: false,
  origin: `https://127.0.0.1:${port}` });
const info = await new Promise((done) => socket.once("message", (data) => done(JSON.parse(data.toString()))));
if (!info.capabilities.includes("clientPublish")) fail("our own page may not publish");
const clear = new WebSocket(`ws://127.0.0.1:${port}/?token=${token}`, ["foxglove.websocket.v1"]);
if (await new Promise((done) => { clear.on("open", () => done(true)); clear.on("error", () => done(false)); })) fail("a socket in clear is open");
console.log("1 passed, 0 failed");
process.exit(0);
