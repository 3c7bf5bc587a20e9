// What the cases of page.mjs share: the program, its scenes, and what a person does at the page.
import assert from "node:assert/strict";
import {spawn} from "node:child_process";
import {existsSync, mkdtempSync, readFileSync, writeFileSync} from "node:fs";
import {connect} from "node:net";
import {tmpdir} from "node:os";
import {join} from "node:path";

import {until} from "./chromium.mjs";

export const directory = mkdtempSync(join(tmpdir(), "pprt-live-"));

export const programs = [];  // all that were started

// pprt-render with a live view on a free port.
export class Program {
  static async start(...words) {
    const program = new Program();
    program.text = "";
    const port = words.includes("--live") ? [] : ["--live", "0"];
    program.child = spawn("pprt-render", [...port, ...words], {stdio: ["ignore", "ignore", "pipe"], cwd: directory});
    program.child.stderr.on("data", (data) => { program.text += data; });
    program.ended = new Promise((resolve) => program.child.on("exit", resolve));
    programs.push(program);
    program.url = await until("the address", () => {
      assert.equal(program.child.exitCode, null, `it has ended: ${program.text}`);
      return program.text.match(/http:\S+/)?.[0];
    }, 60);
    return program;
  }

  async end() {
    this.child.kill("SIGINT");
    return this.ended;
  }
}

export const scene = ["spd:tree:5", "--size", "160x120", "--fps", "12"];

// What the canvas shows, as a text that differs when it does.
export const shown = (page) => page.evaluate("canvas.toDataURL()");
export const camera = async (page) => Number(await page.evaluate("document.body.dataset.camera"));
export const frame = async (page) => Number(await page.evaluate("document.body.dataset.frame"));
export const stateIs = (page, condition) => page.until(`state && (${condition})`);
export const middle = (page) => page.evaluate(
  "(() => { const r = canvas.getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2]; })()");

export async function open(browser, program, settings) {
  const page = await browser.open(program.url, {downloads: directory, ...settings});
  await page.until("document.body.dataset.frame && state");
  return page;
}

export async function take(page) {
  await page.click("take");
  await page.until("pilot.isPilot && pilot.camera !== null");
}

export async function drag(page, right, down, more) {
  const [x, y] = await middle(page);
  await page.drag([x, y], [x + right, y + down], 8, more);
}

// The last camera by hand is on the screen. On a busy machine the page may not have sent it yet.
export const showsHand = "!waiting && shown.look === look";

// Returns the text of a file that the page saves, once it is there.
export const saved = (name) => until(name, () => {
  const file = join(directory, name);
  return existsSync(file) && readFileSync(file, "utf8");
});

// Programs that want all the time of a core, for at most so many seconds.
export function keepBusy(count, seconds) {
  return Array.from({length: count}, () =>
    spawn("timeout", [String(seconds), "sh", "-c", "while :; do :; done"], {stdio: "ignore"}));
}

// Returns so many connections to the program's port that send nothing.
export function keepIdle(program, count) {
  const {hostname, port} = new URL(program.url);
  return Promise.all(Array.from({length: count}, () => new Promise((resolve, reject) => {
    const socket = connect(Number(port), hostname, () => resolve(socket));
    socket.on("data", () => {});  // else its end is not noticed
    socket.on("error", reject);
  })));
}

// Spheres before a bright background, lit from all sides: nothing in it is black.
export function writeBrightScene() {
  const lights = [[4, 3, 2], [-4, 3, 2], [4, -3, 2], [-4, -3, 2], [0, 0, 6], [0, 0, -6]];
  const spheres = Array.from({length: 125}, (_, i) =>
    [i % 5, Math.floor(i / 5) % 5, Math.floor(i / 25)].map((v) => 0.6 * v - 1.2));
  writeFileSync(join(directory, "bright.nff"), [
    "b 0.9 0.8 0.7", "v", "from 4.6 0.4 2", "at 0 0 0", "up 0 0 1", "angle 45", "hither 0.01", "resolution 320 240",
    ...lights.map((at) => `l ${at.join(" ")}`), "f 0.9 0.9 0.4 0.5 0.3 5 0.3 1.3",
    ...spheres.map((at) => `s ${at.join(" ")} 0.2`), ""].join("\n"));
  writeFileSync(join(directory, "round.anim"), `animation { scene "bright.nff" frames 40 fps 12 resolution <320, 240>
    camera { key 1 { from <4.6, 0.4, 2> at <0, 0, 0> up <0, 0, 1> angle 45 } key 20 { from <0, 4, 2> } key 40 { from <-4.6, 1, 2> } } }`);
}

// Notes from now on the number of each frame that has a black square of 8x8 pixels.
export const watchForBlack = (page) => page.evaluate(`pictures = 0, black = []; {
  const before = tell;
  tell = (header) => {
    before(header);
    if (!header.type) return;
    ++pictures;
    const {data, width, height} = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    const brightest = (x, y) => Math.max(...Array.from({length: 64}, (_, i) => data[4 * ((y + (i >> 3)) * width + x + i % 8)]));
    for (let y = 0; y < height; y += 8) for (let x = 0; x < width; x += 8) {
      if (brightest(x, y) < 12) return black.push(header.frames.at(-1).number);
    }
  };
} 1`);

export function noError(page) {
  assert.deepEqual(page.errors, []);
}
