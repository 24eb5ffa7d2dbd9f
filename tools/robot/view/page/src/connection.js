// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The WebSocket to tread-view, with the Foxglove protocol's client library; reconnects by itself.
import { FoxgloveClient } from "@foxglove/ws-protocol";

const TOPICS = ["INS", "MOTOR", "PLAN", "PLAN_TREE", "MAP", "SCAN", "LEARNING", "HEALTH", "PATTERN_SET", "GOAL", "PROGRAM",
  "CONFIG", "FENCE", "FENCES", "view/history", "view/player"];
const RETRY = 1000; // [ms]

export class Connection {
  constructor(url, { onMessage, onOpen, onClose, onStatus }) {
    this.url = url;
    this.handlers = { onMessage, onOpen, onClose, onStatus };
    this.encoder = new TextEncoder();
    this.decoder = new TextDecoder();
    this.open();
  }

  open() {
    const socket = new WebSocket(this.url, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]);
    const client = new FoxgloveClient({ ws: socket });
    const topics = new Map();
    this.client = null;
    this.channels = {};
    client.on("serverInfo", (info) => {
      this.client = client;
      this.mayCommand = info.capabilities.includes("clientPublish");
      if (this.mayCommand)
        for (const topic of ["view/command", "view/control"])
          this.channels[topic] = client.advertise({ topic, encoding: "json", schemaName: "" });
      this.handlers.onOpen(this.mayCommand);
    });
    client.on("advertise", (channels) => {
      for (const channel of channels)
        if (TOPICS.includes(channel.topic)) topics.set(client.subscribe(channel.id), channel.topic);
    });
    client.on("message", ({ subscriptionId, timestamp, data }) => {
      const topic = topics.get(subscriptionId);
      if (topic) this.handlers.onMessage(topic, JSON.parse(this.decoder.decode(data)), Number(timestamp / 1000n));
    });
    client.on("status", (status) => this.handlers.onStatus(status));
    client.on("error", () => {});
    client.on("close", () => {
      this.client = null;
      this.handlers.onClose();
      setTimeout(() => this.open(), RETRY);
    });
  }

  send(topic, message) {
    if (this.client && this.channels[topic] !== undefined)
      this.client.sendMessage(this.channels[topic], this.encoder.encode(JSON.stringify(message)));
  }
  command(message) { this.send("view/command", message); }
  control(message) { this.send("view/control", message); }
}
