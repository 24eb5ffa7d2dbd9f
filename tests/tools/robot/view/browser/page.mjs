// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The page in headless Chromium: node page.mjs MODULES URL log|live PICTURE
import { createRequire } from "node:module";
import { existsSync } from "node:fs";
const [, , modules, url, mode, picture] = process.argv;
const require = createRequire(`${modules}/x.js`);
const { chromium } = require("playwright-core");
const executablePath = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(existsSync);

const fail = (words) => { console.error(words); process.exit(1); };
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--disable-gpu"] });
const page = await browser.newPage({ viewport: { width: 1400, height: 900 } });
page.on("pageerror", (error) => fail(`the page threw: ${error.message}`));
await page.goto(url);
const text = (selector) => page.locator(selector).innerText();
const until = async (what, condition, seconds = 10) => {
  for (let i = 0; i < seconds * 20; ++i) {
    if (await condition()) return;
    await page.waitForTimeout(50);
  }
  await page.screenshot({ path: picture });
  fail(`never: ${what}; the page says "${await text("#headline")}", picture ${picture}`);
};

if (mode === "log") {
  await until("LOG is shown", async () => (await text("#mode")) === "LOG");
  await until("the log's time is known", () => page.evaluate(() => window.treadView.state().player !== null));
  // The slider covers the whole log, and the robot's position follows it.
  const places = [];
  for (const share of [100, 500, 900]) {
    await page.evaluate((value) => {
      const slider = document.getElementById("slider");
      slider.value = value;
      slider.dispatchEvent(new Event("input"));
    }, share);
    await until("the slider's time is reached", () => page.evaluate((value) => {
      const { player } = window.treadView.state();
      return Math.abs((player.now - player.begin) / (player.end - player.begin) - value / 1000) < 0.01;
    }, share));
    await page.waitForTimeout(150);
    places.push(await page.evaluate(() => window.treadView.state().pose()));
    if (share === 500) await page.screenshot({ path: picture });
  }
  await until("the map has tiles", () => page.evaluate(() => window.treadView.state().tiles.size > 3));
  if (Math.hypot(places[0].x - places[2].x, places[0].y - places[2].y) < 3) fail("the robot did not move with the slider");
  // Scrubbing: number of positions answered each second.
  const rate = await page.evaluate(async () => {
    const slider = document.getElementById("slider");
    let answered = 0, last = window.treadView.state().player.answered;
    const begun = performance.now();
    for (let i = 0; performance.now() - begun < 2000; ++i) {
      slider.value = 100 + ((i * 7) % 800);
      slider.dispatchEvent(new Event("input"));
      await new Promise((done) => requestAnimationFrame(done));
      const now = window.treadView.state().player.answered;
      if (now !== last) ++answered;
      last = now;
    }
    return answered / 2;
  });
  console.log(`scrubs at ${rate} frames a second`);
  // The newest is first; later entries may expire before a slow browser reads them.
  await page.locator("#events .event").last().click();
  await page.locator("#play").click();
  await until("it plays", async () => (await text("#play")) === "pause");
  if (!(await page.locator("#estop").isHidden())) fail("a log has no E-stop");
  // The server restarts: the page shows it and reconnects.
  console.log("restart");
  await until("the lost connection is told", async () => (await text("#mode")) === "NO CONNECTION", 20);
  await until("it is back", async () => (await text("#mode")) === "LOG", 20);
  await until("it shows the log again", () => page.evaluate(() => window.treadView.state().history.events.length > 0));
} else {
  await until("LIVE is shown", async () => (await text("#mode")) === "LIVE");
  await until("the robot is known", () => page.evaluate(() => window.treadView.state().pose() !== null));
  await until("the motors are known", async () => (await text("#robot")).includes("disarmed"));
  if (await page.locator("#estop").isHidden()) fail("the E-stop is hidden");
  // A fence by three clicks, far from the path.
  await page.locator("#fence").click();
  const map = await page.locator("#map").boundingBox();
  for (const [x, y] of [[-300, -200], [-220, -200], [-220, -140]])
    await page.mouse.click(map.x + map.width / 2 + x, map.y + map.height / 2 + y);
  await page.locator("#finish").click();
  await until("the fence is there", () => page.evaluate(() => window.treadView.state().standingFences().length === 1));
  // Arms, and drives to a click on the map. A stall of the machine correctly prevents arming or disarms.
  const drives = async () => (await text("#headline")).startsWith("driving");
  for (let i = 0; i < 12 && !(await drives()); ++i) {
    if (await page.locator("#arm").isEnabled()) await page.locator("#arm").click();
    for (let k = 0; k < 40 && (await page.locator("#arm").isEnabled()); ++k) await page.waitForTimeout(100);
    if (await page.locator("#arm").isEnabled()) continue;
    await page.locator("#goal").click();
    await page.mouse.click(map.x + map.width / 2 + 160, map.y + map.height / 2);
    for (let k = 0; k < 40 && !(await drives()); ++k) await page.waitForTimeout(100);
  }
  await until("it drives", drives, 1);
  await page.waitForTimeout(1500);
  await page.screenshot({ path: picture });
  await page.keyboard.press("Space");
  await until("the E-stop is shown", async () => (await text("#headline")).startsWith("E-STOP"), 5);
  // Values without updates turn grey.
  console.log("kill");
  await until("the robot greys out", () => page.evaluate(() => document.getElementById("robot").classList.contains("stale")), 30);
}
await browser.close();
console.log("1 passed, 0 failed");
