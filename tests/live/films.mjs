// The cases of page.mjs in which a person records a film: keys, the script of Save, and the frames that it gives.
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import {readFileSync, writeFileSync} from "node:fs";
import {join} from "node:path";

import {directory, Program, scene, stateIs, open, take, drag, showsHand, saved, noError} from "./stage.mjs";
import {writeModel} from "./model.mjs";

// Keys two cameras, at frame 1 and at `last`, and saves them as film.anim.
async function saveTwoKeys(page, last) {
  await page.click("key");
  await stateIs(page, "state.keys.length === 1");
  await drag(page, 70, 15);
  await page.until(showsHand);
  await page.evaluate(`element('key-frame').value = ${last}, keyFrame = false`);
  await page.click("key");
  await stateIs(page, "state.keys.length === 2");
  await page.click("save");
  await saved("film.anim");
}

// The cameras that the page shows as it plays the film of so many frames.
async function viewsOfFilm(page, frames) {
  await page.click("plays-film");
  await stateIs(page, `state.film && state.frames === ${frames}`);
  if (await page.evaluate("hello.moves")) await page.press(" ");  // what moves plays again and again
  await stateIs(page, "!state.plays");
  const views = [];
  for (let n = 1; n <= frames; ++n) {
    await page.evaluate(`connection.send({do: "seek", frame: ${n}})`);
    views.push(await page.until(`shown.position === ${n} && !shown.by_hand ? shown.view : null`));
  }
  return views;
}

// Writes a script with a key for each of these cameras.
function writeViews(name, scene, views) {
  const vector = (v) => `<${v.join(", ")}>`;
  writeFileSync(join(directory, `${name}.anim`), `animation { scene "${scene}" frames ${views.length} fps 12 resolution <160, 120>
    camera { ${views.map((v, i) => `key ${i + 1} { from ${vector(v.from)} at ${vector(v.at)} up ${vector(v.up)} angle ${v.angle} }`).join("\n")} } }`);
}

// Returns what the program prints.
const run = (...words) =>
  execFileSync("pprt-render", words, {cwd: directory, encoding: "utf8", stdio: ["ignore", "pipe", "ignore"]});

// Renders a script, or a scene and a script, to NAME_1.png and so on, the same pictures every time.
const render = (name, ...words) => run(...words, "--clock", "work", "-o", `${name}_%d.png`);
const picture = (name, frame) => readFileSync(join(directory, `${name}_${frame}.png`)).toString("base64");
const areEqual = (one, other) => picture(...one) === picture(...other);

export const films = {
  "keys that are recorded give a script of the same film": async (browser) => {
    const program = await Program.start(...scene);
    const page = await open(browser, program);
    await take(page);
    await saveTwoKeys(page, 7);
    await page.click("key");
    await page.click("undo");
    await stateIs(page, "state.keys.length === 2");
    const views = await viewsOfFilm(page, 7);
    noError(page);
    await program.end();

    writeViews("views", "spd:tree:5", views);
    for (const name of ["film", "views"]) render(name, `${name}.anim`);
    for (let n = 1; n <= 7; ++n) assert.ok(areEqual(["film", n], ["views", n]), `frame ${n}`);
    assert.ok(!areEqual(["film", 1], ["film", 7]));
  },

  "a model is steered under a script's sun and sky, and its keys make the film": async (browser) => {
    writeFileSync(join(directory, "tent.obj"), `${["-2 0 2", "2 0 2", "0 2 0", "2 0 -2", "-2 0 -2"].map((v) => `v ${v}\n`).join("")}
      ${["1 2 3", "2 4 3", "4 5 3", "5 1 3"].map((f) => `f ${f}\n`).join("")}`);
    writeFileSync(join(directory, "day.anim"), `animation { scene "tent.obj" resolution <160, 120> fps 12
      sun { from <-2, 3, 1> color <1, .9, .8> } sky { up <0, 1, 0> horizon <.8, .8, .9> zenith <.1, .3, .7> } }`);
    const program = await Program.start("day.anim");
    const page = await open(browser, program);
    await take(page);
    await saveTwoKeys(page, 5);
    noError(page);
    await program.end();

    assert.match(run("--census", "film.anim"), /lights +1, of them 1 sun\n[^]*simulated +shadows,sky\n/);
    render("film", "film.anim");
    assert.ok(!areEqual(["film", 1], ["film", 5]));
  },

  "a .glb that moves is steered, and one command makes the film of its keys": async (browser) => {
    writeModel(join(directory, "slider.glb"));
    const program = await Program.start("slider.glb", "--size", "160x120", "--fps", "12");
    const page = await open(browser, program);
    await stateIs(page, "state.plays");
    await take(page);
    await page.press(" ");
    await stateIs(page, "!state.plays");
    await page.evaluate('connection.send({do: "seek", frame: 1})');
    await page.until("shown.position === 1 && element('key-at').textContent === '1'");
    await saveTwoKeys(page, 7);
    const views = await viewsOfFilm(page, 13);  // a second
    noError(page);
    await program.end();

    render("film", "film.anim");
    render("named", "slider.glb", "film.anim");
    writeViews("views", "slider.glb", views);
    render("views", "views.anim");
    writeViews("held", "slider.glb", views.map(() => views[0]));
    render("held", "held.anim");
    for (let n = 1; n <= 7; ++n) {
      for (const name of ["named", "views"]) assert.ok(areEqual(["film", n], [name, n]), `frame ${n} of ${name}`);
    }
    assert.ok(areEqual(["film", 1], ["held", 1]));
    assert.ok(!areEqual(["held", 1], ["held", 7]), "the pyramid slides");
    assert.ok(!areEqual(["film", 7], ["held", 7]), "the camera turns");
    assert.match(run("--census", "film.anim"), /movement +1 object that moves\n[^]*simulated +shadows,textures\n/);
  },

  "keys are moved on the time line, undone and done again, also after the slider had the focus": async (browser) => {
    const program = await Program.start(...scene);
    const page = await open(browser, program);
    await page.evaluate("sayWhoHasIt(), 1");
    await page.until("element('note').textContent.includes('Take the camera first')");
    await page.evaluate("clearTimeout(noteTimer), 1");  // it would go by itself
    await take(page);
    await page.until("element('note').textContent === ''");
    // The second key comes before the program can have answered the first.
    await page.evaluate("element('key').click(), element('key').click(), 1");
    await stateIs(page, "String(state.keys) === '1,25'");
    const place = (f) => page.evaluate(`(() => {
      const mark = document.querySelector('#marks [data-frame="${f}"]').getBoundingClientRect();
      const line = element("marks").getBoundingClientRect();
      return [mark.x + mark.width / 2, mark.y + mark.height / 2, line.width / (state.line - 1)];
    })()`);
    const [x, y, step] = await place(25);
    await page.drag([x, y], [x - 10 * step, y]);
    await stateIs(page, "String(state.keys) === '1,15'");
    const ctrl = 2, shift = 8;
    await page.press("z", {modifiers: ctrl});
    await stateIs(page, "String(state.keys) === '1,25'");
    await page.press("Z", {modifiers: ctrl | shift});
    await stateIs(page, "String(state.keys) === '1,15'");
    await page.evaluate("document.querySelector('#marks [data-frame=\"15\"]').focus(), 1");
    await page.press("ArrowRight");
    await stateIs(page, "String(state.keys) === '1,16'");
    await page.press("ArrowRight");
    await stateIs(page, "String(state.keys) === '1,17'");

    // The playhead of the film is where the next key stands.
    await page.evaluate("element('scrub').focus(), element('scrub').value = 9, element('scrub').dispatchEvent(new Event('input')), 1");
    await page.until("shown.position === 9 && element('key-at').textContent === '9'");
    await page.press("k");
    await stateIs(page, "String(state.keys) === '1,9,17'");
    await drag(page, 40, 0);
    await page.until("element('position').textContent === '9 of 17, by hand'");
    await page.evaluate("element('scrub').focus(), 1");
    await page.press("u");
    await stateIs(page, "String(state.keys) === '1,17'");
    noError(page);
    await program.end();
  },

  "keys that were not saved outlive the program": async (browser) => {
    const program = await Program.start(...scene);
    const page = await open(browser, program);
    await take(page);
    await page.press("k");
    await drag(page, 50, 5);
    await page.until(showsHand);
    await page.press("k");
    await stateIs(page, "state.keys.length === 2");
    const keys = await page.evaluate("JSON.stringify(film.keys)");
    const script = await page.evaluate("film.script");
    assert.equal(await page.evaluate("JSON.stringify(unsaved.get()?.keys)"), keys, "the browser keeps them");
    program.child.kill("SIGKILL");
    await page.until("!element('banner').hidden");
    await page.click("save");
    assert.equal(await saved("film.anim"), script);

    // On the same port the browser finds what it has kept. The offer saves it, drops it or puts it back.
    const {port} = new URL(program.url);
    const again = await Program.start("--live", port, ...scene);
    const kept = await page.evaluate("film");
    for (const button of ["keep", "forget", "restore"]) {
      await page.evaluate(`unsaved.put(${JSON.stringify(kept)}), 1`);
      await page.go(again.url);
      await page.until("state && !element('offer').hidden");
      assert.match(await page.evaluate("element('offer-text').textContent"), /^2 keys /);
      await page.click(button);
      await page.until("element('offer').hidden");
      assert.equal(await page.evaluate("unsaved.get() === null"), button !== "restore");
    }
    await page.until(`JSON.stringify(film.keys) === ${JSON.stringify(keys)}`);
    await again.end();
  },
};
