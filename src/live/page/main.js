// The page: what it knows, what it shows, and what each button does.

const element = (id) => document.getElementById(id);
const canvas = element("picture");
const gauge = new Gauge(element("gauge"), element("gauge-text"));
const lag = new Lag();

let hello = null;       // what the program has told at the beginning
let state = null;       // what it told last
let look = 0;           // number of the last camera that was sent
let shown = null;       // header of the frame on the screen
let film = {keys: [], script: ""};  // the recorded one
let unsaved = null;     // where this browser keeps it
let photos = 0;         // taken
let keyFrame = true;    // the field of the next key's frame follows the keys
let keyAsked = 0;       // frame of the newest key, until the program has it
let lostNumber = 0;     // the number that this viewer had when it lost the connection, with the camera

// One camera for each time that the screen is drawn, whatever the pointers do.
let waiting = null;
const pilot = new Pilot(canvas, (camera) => {
  if (!waiting) requestAnimationFrame(() => {
    lag.send(++look, performance.now());
    connection.send({do: "look", number: look, ...waiting});
    waiting = null;
  });
  waiting = camera;
}, (x, y) => connection.send({do: "pivot", x, y}));
const compass = new Cross(element("cross"));
const marks = new FilmMarks(element("marks"), (command) => connection.send(command));

// --- What comes

let drawing = Promise.resolve();

const connection = new Connection({
  frame: (header, bytes) => {
    // Pictures are decoded one after the other, so that none overtakes another.
    drawing = drawing.then(() => draw(header, bytes)).catch((error) => console.error(error))
      .finally(() => connection.acknowledge());
  },
  photo: (header, bytes) => {
    const name = `photo-${++photos}.${header.photo}`;
    download(new Blob([bytes]), name);
    say(`The photo is saved as ${name}.`);
  },
  text: (message) => {
    if (message.hello) welcome(message.hello);
    if (message.error) keyAsked = 0, say(message.error);
    if (message.end) end(message.end);
    // What is told to all viewers may come before that, and is told again after it.
    if (!hello) return;
    if (message.state) update(message.state);
    if (message.film) takeFilm(message.film);
    if (message.pivot) pilot.turnRound(message.pivot);
  },
  lost: (seconds) => {
    if (pilot.isPilot) lostNumber = hello.you;
    pilot.isPilot = false;
    warn(`The connection is lost. The page tries again in ${seconds} s. If pprt-render has ended, ` +
      "start it again and open the address that it prints.");
  },
  found: () => warn(""),
});

async function draw(header, bytes) {
  if (!hello) return;
  if (header.type) {
    const picture = await createImageBitmap(new Blob([bytes], {type: header.type}));
    if (canvas.width !== picture.width || canvas.height !== picture.height) {
      canvas.width = picture.width;
      canvas.height = picture.height;
      fit();
    }
    canvas.getContext("2d", {alpha: false}).drawImage(picture, 0, 0);
    picture.close();
  }
  shown = header;
  const isOwn = header.pilot === hello.you;
  if (!pilot.isPilot || (isOwn && header.look === look && !waiting)) pilot.camera = header.view;
  if (pilot.isPilot && isOwn) lag.show(header.look, performance.now());
  tell(header);
}

function tell(header) {
  const rate = state ? state.rate : 24;
  gauge.add(header.frames, rate);
  const last = header.frames[header.frames.length - 1];
  // What late ranks have sampled is not known.
  const whole = header.frames.filter((frame) => frame.late.length === 0).pop();
  if (whole) element("samples").textContent = whole.samples.toLocaleString("en");
  element("flip").textContent = header.flip === null ? "–" : header.flip.toFixed(4);
  element("rmse").textContent = errorText(last.rmse);
  element("advice").textContent = last.advice ?? "";
  element("advice").hidden = !last.advice;
  element("late").textContent = last.late.length === 0 ? "none" :
    `${last.late.length === 1 ? "rank" : "ranks"} ${last.late.join(", ")}`;
  const median = lag.median();
  element("lag").textContent =
    median === null ? "–" : `${median.toFixed(0)} ms (${(median * rate / 1000).toFixed(1)})`;
  const frames = state ? state.frames : 0;
  const inPlay = header.position > 0 && frames > 0;
  const isByHand = inPlay ? header.by_hand : header.camera > 1;
  element("position").textContent = (inPlay ? `${header.position} of ${frames}` : isByHand ? "" : "first view") +
    (isByHand ? `${inPlay ? ", " : ""}by hand` : "");
  if (inPlay && !isScrubbing) element("scrub").value = header.position;
  followPlayhead();
  compass.draw(pilot.camera ?? header.view);
  document.body.dataset.camera = header.camera;
  document.body.dataset.frame = last.number;
}

// `rmse`: an error and the ends of its interval, or nothing where too few rays know of it. Has as many decimals
// as show these apart, four at least.
function errorText(rmse) {
  if (!rmse || rmse[2] === 0) return "–";
  const [least, most] = [4, 12];
  for (let decimals = least; ; ++decimals) {
    const [error, low, high] = rmse.map((value) => value.toFixed(decimals));
    const isApart = rmse[1] <= 0 || (Number(low) < Number(error) && Number(error) < Number(high));
    if ((!isApart || Number(high) === 0) && decimals < most) continue;
    return rmse[1] > 0 ? `${error} (${low} to ${high})` : `at most ${high}`;
  }
}

function welcome(message) {
  hello = message;
  pilot.home = hello.home;
  pilot.bounds = hello.bounds ?? null;
  unsaved = new UnsavedFilm(hello.title);
  look = keyAsked = 0;
  lag.forget();
  element("title").textContent = hello.title;
  document.title = `${hello.title} – pprt live`;
  fill(element("overlay"), hello.overlays.map((name) => [name, name]));
}

function update(message) {
  const before = state;
  state = message;
  if (state.keys.includes(keyAsked)) keyAsked = 0;
  if (before && (before.rate !== state.rate || String(before.size) !== String(state.size))) {
    lag.forget();
    gauge.forget();
  }
  const isPilot = state.pilot === hello.you;
  if (isPilot && !pilot.isPilot) {
    look = 0, lag.forget();
    if (element("note").textContent === wantsCamera()) element("note").replaceChildren();
  }
  pilot.isPilot = isPilot;
  // The program may take some seconds to notice that a connection is lost.
  if (lostNumber && state.pilot === 0) connection.send({do: "take"});
  if (state.pilot !== lostNumber) lostNumber = 0;

  canvas.classList.toggle("steered", isPilot);
  const others = state.viewers.filter((viewer) => viewer !== hello.you);
  const number = state.viewers.length;
  element("viewers").textContent = others.length === 0 ? "you alone are watching" :
    `${number} viewers, you are number ${hello.you}` +
      (state.pilot > 0 && !isPilot ? `; number ${state.pilot} has the camera` : "");
  const take = element("take");
  take.firstChild.textContent = isPilot ? "Give it back " : "Take the camera ";
  take.classList.toggle("chosen", isPilot);
  take.disabled = state.pilot > 0 && !isPilot;
  element("pass-label").hidden = !isPilot || others.length === 0;
  fill(element("pass"), [["", "…"], ...others.map((viewer) => [viewer, `number ${viewer}`])]);

  for (const id of ["settings", "film", "transport"]) element(id).disabled = !isPilot;
  element("rate").value = Math.round(100 * Math.log(state.rate) / Math.log(hello.rates[1]));
  element("rate-text").textContent = `${state.rate} ${state.rate === 1 ? "frame" : "frames"}/s`;
  fillSizes();
  element("overlay").value = state.overlay;
  showLegend();
  element("photo").disabled = state.photo;
  if (state.photo) say("The photo is being taken: the frames wait.");
  if (before && before.photo && !state.photo && !isPilot) say("The photo is taken.");

  element("play-shape").setAttribute("d", state.plays ? "M3 2h4v12H3zM9 2h4v12H9z" : "M4 2l9 6-9 6z");
  element("play").setAttribute("aria-label", state.plays ? "Pause" : "Play");
  const isEmpty = state.frames === 0 && state.keys.length === 0;
  for (const id of ["back", "play", "forth", "scrub"]) element(id).disabled = isEmpty;
  element("scrub").max = Math.max(1, state.line);
  element("undo").disabled = !state.undo;
  element("redo").disabled = !state.redo;
  element("plays-film").checked = state.film;
  element("plays-film").disabled = state.keys.length === 0;
  showKeys();
}

function fill(select, entries) {
  const now = select.value;
  const wanted = JSON.stringify(entries);
  if (select.dataset.entries === wanted) return;
  select.dataset.entries = wanted;
  select.replaceChildren(...entries.map(([value, text]) => new Option(text, value)));
  if (entries.some(([value]) => String(value) === now)) select.value = now;
}

// Sizes of the first picture's shape.
function fillSizes() {
  const [width, height] = state.size;
  const own = hello.size;
  const sizes = new Map();
  for (const factor of [0.25, 0.5, 0.75, 1, 1.5, 2]) {
    const size = own.map((side) => Math.max(1, Math.round(side * factor)));
    if (Math.max(...size) <= hello.longest_side) sizes.set(size.join("x"), size);
  }
  sizes.set(`${width}x${height}`, state.size);
  const entries = [...sizes.values()].sort((a, b) => a[0] - b[0]);
  fill(element("size"), entries.map(([w, h]) => [`${w}x${h}`, `${w} × ${h}`]));
  element("size").value = `${width}x${height}`;
  element("size").disabled = hello.fixed_size;
}

function showKeys() {
  element("keys").replaceChildren(...state.keys.map((frame) => {
    const item = document.createElement("li");
    const add = (text, what, act) => {
      const button = document.createElement("button");
      button.textContent = text;
      button.title = what;
      button.setAttribute("aria-label", what);
      button.onclick = act;
      item.append(button);
    };
    add(frame, `Show the key at frame ${frame}`, () => showKey(frame));
    add("✕", `Drop the key at frame ${frame}`, () => connection.send({do: "drop", frame}));
    return item;
  }));
  marks.show(state.keys, state.line);
  followPlayhead();
}

// In the film, which shows the key's camera.
function showKey(frame) {
  connection.send({do: "film", on: true});
  connection.send({do: "seek", frame});
}

// The next key stands at the frame that is shown. Without anything that plays it follows the last one.
function followPlayhead() {
  if (keyFrame && state) {
    const last = Math.max(keyAsked, ...state.keys);
    const next = last > 0 ? last + Math.round(2 * state.rate) : 1;
    const frame = state.frames > 0 ? Math.max(1, shown?.position ?? 1) : next;
    if (document.activeElement !== element("key-frame")) element("key-frame").value = frame;
  }
  element("key-at").textContent = element("key-frame").value;
}

// --- The film's keys, here and in this browser

function takeFilm(message) {
  const before = film.keys.length;
  film = message;
  element("save").disabled = film.keys.length === 0;
  if (pilot.isPilot && film.keys.length > 0) unsaved.put(film);
  if (pilot.isPilot && film.keys.length === 0 && before > 0) unsaved.forget();
  offerUnsaved();
}

// Keys that this browser has and the program has not.
function offerUnsaved() {
  const kept = film.keys.length === 0 && !pilot.isPilot ? unsaved.get() : null;
  element("offer").hidden = !kept;
  if (!kept) return;
  const keys = kept.keys.length === 1 ? "A key" : `${kept.keys.length} keys`;
  element("offer-text").textContent = `${keys} of an earlier film of this scene ${kept.keys.length === 1 ? "was" : "were"} not saved.`;
}

function saveFilm(saved) {
  download(new Blob([saved.script], {type: "text/plain"}), "film.anim");
  unsaved.forget();
  offerUnsaved();
  say("The script is saved as film.anim.");
}

// Fewer than the program takes in a second.
async function putBack(kept) {
  connection.send({do: "take"});
  for (const {frame, view} of kept.keys) {
    connection.send({do: "key", frame, view});
    if (frame % 10 === 0) await new Promise((resolve) => setTimeout(resolve, 100));
  }
}

// --- What is shown beside the picture

let noteTimer = 0;
function say(text) {
  const span = document.createElement("span");
  span.textContent = text;
  element("note").replaceChildren(span);
  clearTimeout(noteTimer);
  noteTimer = setTimeout(() => element("note").replaceChildren(), 5000);
}

const isTouched = matchMedia("(pointer: coarse)").matches;
const wantsCamera = () => isTouched ? "Tap “Take the camera” first." : "Take the camera first: t";
function sayWhoHasIt() {
  say(state && state.pilot > 0 ? `Viewer number ${state.pilot} has the camera.` : wantsCamera());
}
canvas.addEventListener("pointerdown", () => { if (!pilot.isPilot) sayWhoHasIt(); });

// What the colours over the picture mean.
const legends = {
  samples: () => "A yellow dot for each ray from the eye that the picture is made of.",
  triangulation: () => "Yellow lines join neighbouring samples.",
  regions: () => hello.ranks > 1 ? `A colour for the part of each of the ${hello.ranks} ranks. The parts follow the work.` :
    "One rank renders the whole picture: there is one region. --threads or -np makes more.",
  age: () => "Frames since what is shown was traced: 0 <i></i> 31.",
};
function showLegend() {
  const text = legends[state.overlay]?.() ?? "";
  element("legend").hidden = !text;
  element("legend").innerHTML = text;
}

// Nothing more can be asked for, but what was recorded can be saved.
function end(text) {
  warn(text);
  pilot.isPilot = false;
  element("note").replaceChildren();
  element("viewers").textContent = "";
  for (const id of ["take", "settings", "film", "transport"]) element(id).disabled = true;
  element("pass-label").hidden = true;
}

function warn(text) {
  element("banner").textContent = text;
  element("banner").hidden = text === "";
}

// As large as the stage allows, with square pixels.
function fit() {
  const stage = element("stage");
  const narrow = matchMedia("(max-width: 46em)").matches;
  const high = narrow ? innerHeight * 0.6 : stage.clientHeight - 16;
  const factor = Math.min((stage.clientWidth - 16) / canvas.width, high / canvas.height);
  canvas.style.width = `${Math.max(1, Math.floor(canvas.width * factor))}px`;
  canvas.style.height = `${Math.max(1, Math.floor(canvas.height * factor))}px`;
}
new ResizeObserver(fit).observe(element("stage"));

function download(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// --- What is done

function inFilmOrScript(command) {
  if (state.frames === 0) connection.send({do: "film", on: true});
  connection.send(command);
}

const actions = {
  take: () => connection.send({do: pilot.isPilot ? "give" : "take"}),
  // Without a script the film plays.
  play: () => inFilmOrScript({do: state.plays ? "pause" : "play"}),
  back: () => inFilmOrScript({do: "step", by: -1}),
  forth: () => inFilmOrScript({do: "step", by: 1}),
  key: () => {
    keyFrame = true;
    keyAsked = Number(element("key-frame").value);
    connection.send({do: "key", frame: keyAsked});
    followPlayhead();
  },
  undo: () => connection.send({do: "undo"}),
  redo: () => connection.send({do: "redo"}),
  save: () => saveFilm(film),
  keep: () => saveFilm(unsaved.get()),
  restore: () => putBack(unsaved.get()),
  forget: () => {
    unsaved.forget();
    offerUnsaved();
  },
  cross: () => pilot.frameAll(),
  photo: () => connection.send({do: "photo", format: element("format").value}),
  theme: () => {
    const dark = document.documentElement.dataset.theme ?
      document.documentElement.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
    document.documentElement.dataset.theme = dark ? "light" : "dark";
    if (state) gauge.draw(1000 / state.rate);
  },
  "help-button": () => element("help").showModal(),
};
for (const [id, act] of Object.entries(actions)) element(id).addEventListener("click", act);

const settings = {
  rate: (value) => ({do: "rate", fps: Math.max(1, Math.round(hello.rates[1] ** (value / 100)))}),
  size: (value) => ({do: "size", width: Number(value.split("x")[0]), height: Number(value.split("x")[1])}),
  overlay: (value) => ({do: "overlay", name: value}),
  pass: (value) => ({do: "pass", to: Number(value)}),
};
for (const [id, command] of Object.entries(settings)) {
  element(id).addEventListener("change", (event) => connection.send(command(event.target.value)));
}
element("pass").addEventListener("change", () => { element("pass").value = ""; });
let isScrubbing = false;
element("scrub").addEventListener("pointerdown", () => { isScrubbing = true; });
element("scrub").addEventListener("pointerup", () => { isScrubbing = false; });
element("scrub").addEventListener("input", (event) => inFilmOrScript({do: "seek", frame: Number(event.target.value)}));
element("plays-film").addEventListener("change", (event) => {
  connection.send({do: "film", on: event.target.checked});
  if (event.target.checked) connection.send({do: "play"});
});
element("key-frame").addEventListener("input", () => {
  keyFrame = false;
  followPlayhead();
});
for (const term of document.querySelectorAll("aside [title]:not(button)")) {
  term.addEventListener("click", () => say(term.title));
}

const shortcuts = {t: "take", " ": "play", b: "back", n: "forth", k: "key", u: "undo", s: "save", p: "photo", "?": "help-button"};
// What an element does itself with a key.
function isForElement(target, key) {
  if (target.tagName === "BUTTON") return key === " " || key === "Enter";
  if (target.type === "checkbox") return key === " ";
  if (target.type === "range") return /^(Arrow.*|Home|End|Page.*)$/.test(key);
  return /^(INPUT|SELECT|TEXTAREA)$/.test(target.tagName);
}

// Ctrl-Z undoes, Ctrl-Shift-Z and Ctrl-Y do it again.
function undoOf(event) {
  if (!(event.ctrlKey || event.metaKey) || event.altKey) return null;
  const key = event.key.toLowerCase();
  return key === "z" ? (event.shiftKey ? "redo" : "undo") : key === "y" ? "redo" : null;
}

document.addEventListener("keydown", (event) => {
  if (isForElement(event.target, event.key) || element("help").open) return;
  const undo = undoOf(event);
  if ((event.ctrlKey || event.metaKey) && !undo) return;
  if (!undo && pilot.key(event)) return event.preventDefault();
  const overlay = element("overlay");
  if (event.key === "o" && pilot.isPilot) {
    overlay.selectedIndex = (overlay.selectedIndex + 1) % overlay.length;
    return overlay.dispatchEvent(new Event("change"));
  }
  const button = element(undo ?? shortcuts[event.key]);
  const needsCamera = button ? !["take", "save", "help-button"].includes(button.id) : /^(Arrow.*|Home|[-+=,.\[\]ho])$/.test(event.key);
  if (needsCamera && !pilot.isPilot) return sayWhoHasIt();
  if (!button || button.matches(":disabled")) return;
  event.preventDefault();
  button.click();
});
