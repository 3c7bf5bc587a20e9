// The live page in a real browser: node page.mjs CASE. `pprt-render` is on the PATH.
import assert from "node:assert/strict";
import {existsSync, readdirSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {join} from "node:path";

import {Chromium, sleep, until} from "./chromium.mjs";
import {films} from "./films.mjs";
import {
  directory, programs, Program, scene, shown, camera, frame, stateIs, middle, open, take, drag, showsHand, keepBusy,
  writeBrightScene, watchForBlack, keepIdle, noError
} from "./stage.mjs";

const cases = {
  ...films,

  "a script plays, and the token is needed": async (browser) => {
    writeFileSync(join(directory, "turn.anim"), `animation { scene "spd:tree:5" frames 40 fps 12 resolution <160, 120>
      camera { key 1 { from <4.6, 0.4, 2> at <0, 0, 1.5> up <0, 0, 1> angle 45 } key 40 { from <-4.6, 1, 2> } } }`);
    const program = await Program.start("turn.anim");
    const {origin} = new URL(program.url);
    assert.equal((await fetch(program.url)).status, 200);
    assert.equal((await fetch(`${origin}/`)).status, 403);
    assert.equal((await fetch(program.url.replace(/.\/$/, "x/"))).status, 403);
    const page = await open(browser, program);
    const first = await shown(page), before = await frame(page);
    await page.until(`Number(document.body.dataset.frame) > ${before + 4}`);
    assert.notEqual(await shown(page), first);
    await stateIs(page, "!state.plays");
    await page.until("element('position').textContent === '40 of 40'");
    noError(page);
    assert.equal(await program.end(), 0);
    await page.until("element('banner').textContent.includes('has ended')");
  },

  "what all viewers are told may come before the greeting": async (browser) => {
    const program = await Program.start(...scene);
    const page = await open(browser, program);
    await page.until("shown.at_rest");
    const early = (message) => page.evaluate(`{ const told = hello; hello = null;
      try { connection.on.text(${message}) } finally { hello = told } } 1`);
    await early("{state}");
    await early("{film: {keys: [], title: 'early'}}");
    await page.evaluate("connection.on.text({state}), 1");
    await take(page);
    noError(page);
    await program.end();
  },

  "a drag turns the camera of who has taken it": async (browser) => {
    const program = await Program.start(...scene);
    const page = await open(browser, program);
    await page.until("shown.at_rest");
    const still = await shown(page), number = await camera(page);
    await drag(page, 60, 20);
    await sleep(300);
    assert.equal(await camera(page), number, "nobody steers who has not taken the camera");
    await take(page);
    await drag(page, 60, 20);
    await page.until(`Number(document.body.dataset.camera) > ${number} && ${showsHand}`);
    assert.notEqual(await shown(page), still);
    const [from, at] = await page.evaluate("[shown.view.from, pilot.home.from]");
    assert.notDeepEqual(from, at);
    assert.ok(await page.evaluate("lag.median() > 0"));
    noError(page);
    await program.end();
  },

  "mouse, touch and keys move the camera as they should": async (browser) => {
    const program = await Program.start(...scene);
    const page = await open(browser, program);
    await take(page);
    const home = await page.evaluate("pilot.home");
    const distance = "length(subtract(pilot.camera.from, pilot.camera.at))";
    const at = () => page.evaluate(`[${distance}, pilot.camera]`);
    const [far] = await page.evaluate("[length(subtract(pilot.home.from, pilot.home.at))]");
    const near = (a, b) => assert.ok(Math.abs(a - b) < 1e-6 * Math.abs(b), `${a} is not ${b}`);

    await drag(page, 50, 10);
    let [d, now] = await at();
    near(d, far);
    assert.deepEqual(now.at, home.at);
    assert.notDeepEqual(now.from, home.from);

    await drag(page, 50, 10, {modifiers: 8});  // Shift
    [d, now] = await at();
    near(d, far);
    assert.notDeepEqual(now.at, home.at);

    const [x, y] = await middle(page);
    await page.mouse("mouseWheel", x, y, {deltaX: 0, deltaY: 120, buttons: 0});
    await page.until(`${distance} > ${far} * 1.01`);
    await page.mouse("mouseWheel", x, y, {deltaX: 0, deltaY: 120, buttons: 0, modifiers: 1});  // Alt
    await page.until(`pilot.camera.angle > ${home.angle}`);
    await drag(page, 60, 0, {modifiers: 1});
    assert.notDeepEqual((await at())[1].up, home.up);

    // Back to the first view by keys alone; then each key.
    await page.press("h");
    await page.until("JSON.stringify(pilot.camera) === JSON.stringify(pilot.home)");
    const changes = {ArrowLeft: "from", "+": "from", "[": "angle", ",": "up"};
    for (const [key, part] of Object.entries(changes)) {
      await page.press("h");
      await page.press(key);
      assert.notDeepEqual((await at())[1][part], home[part], key);
    }
    await page.press("h");
    await page.press("ArrowLeft", {modifiers: 8});
    assert.notDeepEqual((await at())[1].at, home.at);

    // Two fingers spread: nearer.
    await page.press("h");
    const touch = (type, points) => page.call("Input.dispatchTouchEvent",
      {type, touchPoints: points.map(([dx, id]) => ({x: x + dx, y, id}))});
    await touch("touchStart", [[-20, 1], [20, 2]]);
    for (const spread of [30, 40, 50]) await touch("touchMove", [[-spread, 1], [spread, 2]]);
    await touch("touchEnd", []);
    assert.ok((await at())[0] < far * 0.9);
    noError(page);
    await program.end();
  },

  "a reload and a lost connection are no loss": async (browser) => {
    const program = await Program.start(...scene);
    const page = await open(browser, program);
    await page.go(program.url);
    await page.until("document.body.dataset.frame && state && state.viewers.length === 1");
    await take(page);
    await page.evaluate("connection.socket.close(), 1");
    await page.until("!element('banner').hidden && element('banner').textContent.includes('tries again')");
    await page.until("element('banner').hidden && pilot.isPilot");
    const number = await camera(page);
    await drag(page, 40, 0);
    await page.until(`Number(document.body.dataset.camera) > ${number}`);
    noError(page);
    await program.end();
  },

  "the camera passes from viewer to viewer": async (browser) => {
    const program = await Program.start(...scene);
    const one = await open(browser, program), two = await open(browser, program);
    await take(one);
    await stateIs(two, "state.pilot > 0");
    assert.ok(await two.evaluate("element('take').disabled && element('film').disabled"));
    await two.evaluate('connection.send({do: "rate", fps: 30})');
    await two.until("element('note').textContent.includes('take the camera first')");
    const other = await two.evaluate("hello.you");
    await one.evaluate(`element("pass").value = ${other}, element("pass").dispatchEvent(new Event("change"))`);
    await two.until("pilot.isPilot");
    await one.until("!pilot.isPilot");
    noError(one), noError(two);
    await program.end();
  },

  "rate, size, overlay and photo": async (browser) => {
    const program = await Program.start(...scene);
    const page = await open(browser, program);
    await take(page);
    const choose = (id, value) => page.evaluate(`element("${id}").value = ${JSON.stringify(value)}, element("${id}").dispatchEvent(new Event("change"))`);
    await choose("rate", 80);
    await stateIs(page, "state.rate > 30");
    await choose("size", "80x60");
    await page.until("canvas.width === 80 && canvas.height === 60");
    await choose("size", "160x120");
    await page.until("canvas.width === 160");
    await page.until("shown.at_rest && shown.flip !== null");
    const plain = await shown(page);
    const seen = new Set([plain]);
    for (const name of ["samples", "triangulation", "regions", "age"]) {
      await choose("overlay", name);
      await page.until(`shown.at_rest && canvas.toDataURL() !== ${JSON.stringify([...seen].pop())}`);
      seen.add(await shown(page));
    }
    assert.equal(seen.size, 5);
    await choose("overlay", "none");
    for (const [format, magic] of [["png", [0x89, 0x50, 0x4e, 0x47]], ["exr", [0x76, 0x2f, 0x31, 0x01]]]) {
      await choose("format", format);
      await page.click("photo");
      const file = join(directory, `photo-${format === "png" ? 1 : 2}.${format}`);
      await until(format, () => existsSync(file) && readFileSync(file).length > 1000);
      assert.deepEqual([...readFileSync(file).subarray(0, 4)], magic);
      await stateIs(page, "!state.photo");
    }
    noError(page);
    await program.end();
  },

  "a telephone's width, and a list of the keys": async (browser) => {
    const program = await Program.start(...scene);
    const page = await open(browser, program, {width: 360, height: 740, dark: true, touch: true});
    assert.ok(await page.evaluate("document.documentElement.scrollWidth <= innerWidth"));
    assert.ok(await page.evaluate(`(() => {
      const box = element("key").getBoundingClientRect();
      return box.width > 0 && box.top >= 0 && box.left >= 0 && box.bottom <= innerHeight && box.right <= innerWidth;
    })()`), "the key button is in sight");
    await page.evaluate('element("picture").dispatchEvent(new PointerEvent("pointerdown", {pointerId: 1}))').catch(() => {});
    await page.until("element('note').textContent.includes('Tap')");
    const unexplained = await page.evaluate(`[...document.querySelectorAll("dt, #gauge-text")].filter((e) => !e.title).map((e) => e.textContent)`);
    assert.deepEqual(unexplained, [], "figures without an explanation on hover");
    await page.evaluate("document.querySelector('dt').click()");
    await page.until("element('note').textContent.includes('Rays from the eye')");
    const dark = await page.evaluate("getComputedStyle(document.body).backgroundColor");
    await page.click("theme");
    assert.notEqual(await page.evaluate("getComputedStyle(document.body).backgroundColor"), dark);
    await page.press("?");
    assert.ok(await page.evaluate("element('help').open"));
    assert.deepEqual(await page.evaluate(`[...document.querySelectorAll("#help th")].slice(0, 4)
      .map((cell) => getComputedStyle(cell).display !== "none")`), [true, false, true, false], "help speaks of touch");
    const unnamed = await page.evaluate(`[...document.querySelectorAll("button, input, select, canvas")].filter((e) =>
      !(e.textContent.trim() || e.getAttribute("aria-label") || e.closest("label") || e.getAttribute("aria-hidden"))).map((e) => e.id)`);
    assert.deepEqual(unnamed, []);
    noError(page);
    await program.end();
  },

  "what moves goes on under the hand that takes the camera, again and again": async (browser) => {
    writeFileSync(join(directory, "ball.nff"), "f 1 0.2 0.1 1 0 0 0 0\ns 0 0 0 0.4\n");
    writeFileSync(join(directory, "floor.nff"), "b 0.5 0.6 0.7\nv\nfrom 0 -6 2\nat 0 0 0\nup 0 0 1\nangle 45\n" +
      "hither 0.1\nresolution 160 120\nl 5 -5 9\nf 0.5 0.5 0.5 1 0 0 0 0\np 4\n-9 -9 -1\n9 -9 -1\n9 9 -1\n-9 9 -1\n");
    writeFileSync(join(directory, "roll.anim"), `animation { scene "floor.nff" frames 30 fps 12 resolution <160, 120>
      object "ball.nff" { key 1 { translate <-2, 0, 0> } key 30 { translate <2, 0, 0> } } }`);
    const program = await Program.start("roll.anim");
    const page = await open(browser, program);
    const before = await page.evaluate("shown.position");
    await take(page);
    await drag(page, 30, 5);
    await page.until(`${showsHand} && shown.by_hand`);
    const steered = await page.evaluate("shown.view.from");
    const pictures = new Set();
    const end = await frame(page) + 40;  // more than the script has
    await until("the frames go on", async () => pictures.add(await shown(page)) && await frame(page) >= end, 60);
    assert.ok(pictures.size > 10, "the ball rolls");
    assert.deepEqual(await page.evaluate("shown.view.from"), steered);
    assert.ok(await page.evaluate("state.plays"));
    assert.match(await page.evaluate("element('position').textContent"), /^\d+ of 30, by hand$/);
    // A key stands where the ball is.
    await page.press(" ");
    await stateIs(page, "!state.plays");
    await page.until("shown.at_rest");  // the last frame that was on its way is here
    await page.until("Number(element('key-at').textContent) === shown.position");
    await page.press("k");
    await stateIs(page, "state.keys.length === 1 && state.keys[0] === shown.position");
    noError(page);
    await program.end();
  },

  "frame all, a point to turn round, the axes, legends, and who is late": async (browser) => {
    const program = await Program.start(...scene, "--threads", "1");
    const page = await open(browser, program);
    await take(page);
    await page.press("Home");
    await page.until(`${showsHand} && !shown.view.at.every((v, i) => v === pilot.home.at[i])`);
    const [least, most] = await page.evaluate("hello.bounds");
    const framed = await page.evaluate("pilot.camera");
    framed.at.forEach((v, i) => assert.ok(Math.abs(v - (least[i] + most[i]) / 2) < 1e-9));
    await page.press("h");
    await page.until(showsHand);
    await page.click("cross");
    assert.deepEqual(await page.evaluate("pilot.camera"), framed);
    await page.press("h");
    await page.until(showsHand);
    const axes = await page.evaluate("element('cross').toDataURL()");
    const [x, y] = await middle(page);
    await page.mouse("mousePressed", x + 20, y + 25, {clickCount: 1});
    await page.mouse("mouseReleased", x + 20, y + 25, {clickCount: 1, buttons: 0});
    await page.mouse("mousePressed", x + 20, y + 25, {clickCount: 2});
    await page.mouse("mouseReleased", x + 20, y + 25, {clickCount: 2, buttons: 0});
    await page.until(`${showsHand} && !pilot.camera.at.every((v, i) => v === pilot.home.at[i])`);
    assert.deepEqual(await page.evaluate("pilot.camera.from"), await page.evaluate("pilot.home.from"));
    const pivot = await page.evaluate("pilot.camera.at");
    await drag(page, 60, 10);
    assert.notDeepEqual(await page.evaluate("pilot.camera.from"), await page.evaluate("pilot.home.from"));
    assert.deepEqual(await page.evaluate("pilot.camera.at"), pivot);
    await page.until(`element('cross').toDataURL() !== ${JSON.stringify(axes)}`);
    const legends = {regions: "One rank renders the whole picture", age: "Frames since", samples: "A yellow dot for each ray",
      triangulation: "Yellow lines join neighbouring samples"};
    for (const [name, legend] of Object.entries(legends)) {
      await page.evaluate(`connection.send({do: "overlay", name: "${name}"}), 1`);
      await page.until(`!element('legend').hidden && element('legend').textContent.includes('${legend}')`);
    }
    await page.evaluate('connection.send({do: "overlay", name: "none"}), 1');
    await page.until("element('legend').hidden");
    const late = (ranks) => page.evaluate(`tell({...shown, frames: [{number: 1, slack_ms: -1, samples: 0, late: [${ranks}]}]}), element("late").textContent`);
    assert.equal(await late(""), "none");
    assert.equal(await late("0"), "rank 0");
    assert.equal(await late("0, 2"), "ranks 0, 2");
    // The error that was measured, and what helps.
    await page.until("shown.frames.some((frame) => frame.rmse && frame.rmse[0] >= frame.rmse[1] && frame.rmse[2] > 0)");
    const told = (figures, id) => page.evaluate(`tell({...shown, frames: [{number: 1, slack_ms: 1, samples: 0, late: [], ...${JSON.stringify(figures)}}]}), element("${id}").textContent + (element("${id}").hidden ? " hidden" : "")`);
    assert.equal(await told({rmse: [0.0174, 0.01512, 0.02], advice: ""}, "rmse"), "0.0174 (0.0151 to 0.0200)");
    assert.equal(await told({rmse: [0.0174, 0, 0.02], advice: ""}, "rmse"), "at most 0.0200");
    assert.equal(await told({rmse: [0.0081, 0.00809, 0.00811], advice: ""}, "rmse"), "0.00810 (0.00809 to 0.00811)");
    assert.equal(await told({rmse: [0, 0, 0.00002], advice: ""}, "rmse"), "at most 0.00002");
    assert.equal(await told({rmse: [0, 0, 0], advice: ""}, "rmse"), "–");
    assert.equal(await told({rmse: null, advice: ""}, "rmse"), "–");
    assert.equal(await told({rmse: null, advice: "a smaller picture helps"}, "advice"), "a smaller picture helps");
    assert.equal(await told({rmse: null, advice: ""}, "advice"), " hidden");
    noError(page);
    await program.end();
  },

  "no tile is black after a jump, on two and four ranks beside busy programs": async (browser) => {
    writeBrightScene();
    for (const ranks of [2, 4]) {
      const busy = keepBusy(3, 60);
      const program = await Program.start("round.anim", "-np", String(ranks));
      const page = await open(browser, program);
      await watchForBlack(page);
      await take(page);
      for (let i = 0; i < 20; ++i) {
        const before = await frame(page);
        await page.evaluate(`connection.send({do: "seek", frame: ${1 + i * 17 % 40}})`);
        await sleep(150);
        if (i % 3 === 0) await page.evaluate(`connection.send({do: "rate", fps: ${[12, 30, 60, 24][i / 3 % 4]}})`);
        if (i % 4 === 1) await page.evaluate('connection.send({do: "play"})');
        await page.until(`Number(document.body.dataset.frame) > ${before + 3}`, 60);
      }
      assert.ok(await page.evaluate("pictures > 40"));
      assert.deepEqual(await page.evaluate("black"), []);
      noError(page);
      await program.end();
      for (const child of busy) child.kill();
    }
  },

  "connections that say nothing keep no viewer out, and are closed": async (browser) => {
    const program = await Program.start(...scene);
    const early = await open(browser, program);
    const idle = await keepIdle(program, 64);
    const late = await open(browser, program);
    await stateIs(late, "state.viewers.length === 2");
    await until("the end of all that say nothing", () => idle.every((socket) => socket.destroyed), 60);
    for (const page of [early, late]) {
      assert.equal(await page.evaluate("connection.socket.readyState"), 1);
      noError(page);
    }
    await program.end();
  },

  "two processes serve one sequence after the other, and sleep in between": async (browser) => {
    const program = await Program.start(...scene, "-np", "2");
    const page = await open(browser, program);
    await take(page);
    for (const fps of [30, 5, 60]) {
      await page.evaluate(`connection.send({do: "rate", fps: ${fps}})`);
      await stateIs(page, `state.rate === ${fps}`);
      const before = await frame(page);
      await drag(page, 20, 5);
      await page.until(`Number(document.body.dataset.frame) > ${before + 3} && ${showsHand}`);
    }
    // Finished, no frame is made until the camera moves.
    const still = await until("a rest", async () => {
      const number = await frame(page);
      await sleep(700);
      return await frame(page) === number && number;
    });
    await page.press("ArrowLeft");
    await page.until(`Number(document.body.dataset.frame) > ${still}`);
    noError(page);
    assert.equal(await program.end(), 0);
  },

  "a lost connection that the program has not noticed gives the camera back": async (browser) => {
    const program = await Program.start(...scene);
    const page = await open(browser, program);
    await take(page);
    // A second connection, while the first one is still there.
    await page.evaluate("old = connection.socket, old.onclose(), old.onclose = null, 1");
    await page.until("hello.you === 2 && state.pilot === 1");
    await page.evaluate("old.close(), 1");
    await page.until("pilot.isPilot && state.pilot === 2");
    noError(page);
    await program.end();
  },

  "files are written beside the live view": async (browser) => {
    writeFileSync(join(directory, "short.anim"), `animation { scene "spd:tree:5" frames 8 fps 12 resolution <160, 120>
      camera { key 1 { from <4.6, 0.4, 2> at <0, 0, 1.5> up <0, 0, 1> angle 45 } key 8 { from <4.6, 1, 2> } } }`);
    const program = await Program.start("short.anim", "-o", "written_%d.png");
    assert.equal(await program.ended, 0);
    assert.equal(readdirSync(directory).filter((name) => /^written_\d+\.png$/.test(name)).length, 8);
    assert.match(program.text, /done: 8 of 8 frames/);

    // A pilot who comes, seeks and leaves takes no frame away.
    const steered = await Program.start("short.anim", "-o", "steered_%d.png");
    const page = await open(browser, steered);
    await page.evaluate('connection.send({do: "take"}), connection.send({do: "seek", frame: 8})');
    await page.evaluate("connection.ended = true, connection.socket.close(), 1");
    assert.equal(await steered.ended, 0);
    assert.equal(readdirSync(directory).filter((name) => /^steered_\d+\.png$/.test(name)).length, 8);
  },
};

const clean = () => rmSync(directory, {recursive: true, force: true});
if (process.argv[2] === "list") {
  console.log(Object.keys(cases).join("\n"));
  clean();
  process.exit(0);
}
const run = cases[process.argv[2]];
assert.ok(run, `there is no case ${process.argv[2]}`);
const browser = await Chromium.launch();
try {
  await run(browser);
  console.log(`passed: ${process.argv[2]}`);
} catch (error) {
  console.error(error);
  process.exitCode = 1;
} finally {
  await browser.close();
  for (const program of programs) program.child.kill("SIGKILL");
  clean();
}
process.exit();
