// Photographs the live page: node screenshots.mjs DIRECTORY. `pprt-render` is on the PATH.
import {spawn} from "node:child_process";
import {join} from "node:path";

import {Chromium, sleep, until} from "./chromium.mjs";

const directory = process.argv[2];
const program = spawn("pprt-render", ["--live", "0", "spd:tree", "--threads", "auto", "--size", "512x512", "--fps", "10"],
  {stdio: ["ignore", "ignore", "pipe"]});
let text = "";
program.stderr.on("data", (data) => { text += data; });
const url = await until("the address", () => text.match(/http:\S+/)?.[0]);
const browser = await Chromium.launch();
try {
  const page = await browser.open(url, {width: 1180, height: 700});
  await page.until("document.body.dataset.frame && state");
  await page.click("take");
  await page.until("pilot.isPilot && pilot.camera");
  const middle = await page.evaluate("(() => { const r = canvas.getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2]; })()");
  for (const shift of [-90, 110]) {
    await page.click("key");
    await page.drag(middle, [middle[0] + shift, middle[1] + 12], 25);
  }
  await page.click("key");
  await page.until("state.keys.length === 3");
  await page.drag(middle, [middle[0] - 60, middle[1] - 20], 60);
  await sleep(150);
  await page.screenshot(join(directory, "live.png"));
  await page.evaluate('connection.send({do: "overlay", name: "regions"})');
  await page.drag(middle, [middle[0] + 20, middle[1] + 6], 30);
  await page.until("shown.at_rest");
  const phone = await browser.open(url, {width: 390, height: 780, dark: true});
  await phone.until("document.body.dataset.frame && state");
  await sleep(1500);
  await phone.screenshot(join(directory, "phone.png"));
} finally {
  await browser.close();
  program.kill("SIGINT");
}
process.exit();
