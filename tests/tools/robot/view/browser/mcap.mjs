// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Reads an MCAP file with the format's reference readers and checks every checksum: node mcap.mjs MODULES FILE
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
const require = createRequire(`${process.argv[2]}/x.js`);
const { McapIndexedReader, McapStreamReader } = require("@mcap/core");
const { decompress } = require("fzstd");

const file = readFileSync(process.argv[3]);
const decompressHandlers = { zstd: (bytes) => decompress(bytes) };
const stream = new McapStreamReader({ validateCrcs: true, decompressHandlers });
stream.append(file);
let streamed = 0;
for (let record; (record = stream.nextRecord()); ) {
  if (record.type === "Schema") JSON.parse(Buffer.from(record.data).toString());
  if (record.type !== "Message") continue;
  ++streamed;
  JSON.parse(Buffer.from(record.data).toString());
}
if (!stream.done()) throw new Error("the stream has no end");
const readable = { size: async () => BigInt(file.length),
  read: async (offset, size) => new Uint8Array(file.buffer, file.byteOffset + Number(offset), Number(size)) };
const indexed = await McapIndexedReader.Initialize({ readable, decompressHandlers });
let last = 0n;
let found = 0;
for await (const message of indexed.readMessages()) {
  if (message.logTime < last) throw new Error("out of order");
  last = message.logTime;
  ++found;
}
if (found !== streamed || indexed.statistics.messageCount !== BigInt(found)) throw new Error("counts differ");
console.log(`${found} messages\n1 passed, 0 failed`);
