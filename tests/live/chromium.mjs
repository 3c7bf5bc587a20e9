// Drives Debian's chromium through its debugging protocol, over a pipe.
import {spawn} from "node:child_process";
import {mkdtempSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";

export const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

// Waits until `condition` gives something that counts as true, and returns it.
export async function until(what, condition, seconds = 20) {
  const end = Date.now() + 1000 * seconds;
  while (Date.now() < end) {
    const found = await condition();
    if (found) return found;
    await sleep(50);
  }
  throw new Error(`waited ${seconds} s in vain: ${what}`);
}

export class Chromium {
  static async launch() {
    const browser = new Chromium();
    browser.home = mkdtempSync(join(tmpdir(), "pprt-chromium-"));
    browser.child = spawn("chromium", [
      "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
      "--remote-debugging-pipe", `--user-data-dir=${browser.home}`, "about:blank"],
      {stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"], env: {...process.env, HOME: browser.home}});
    browser.calls = new Map();
    browser.listeners = [];
    browser.lastCall = 0;
    let text = "";
    browser.child.stdio[4].on("data", (data) => {
      text += data;
      const messages = text.split("\0");
      text = messages.pop();
      for (const message of messages) browser.receive(JSON.parse(message));
    });
    await browser.call("Browser.getVersion");
    return browser;
  }

  receive(message) {
    const call = this.calls.get(message.id);
    if (call) {
      this.calls.delete(message.id);
      if (message.error) call.reject(new Error(message.error.message));
      else call.resolve(message.result);
    }
    for (const listener of this.listeners) listener(message);
  }

  call(method, params = {}, sessionId = undefined) {
    const id = ++this.lastCall;
    return new Promise((resolve, reject) => {
      this.calls.set(id, {resolve, reject});
      this.child.stdio[3].write(JSON.stringify({id, method, params, sessionId}) + "\0");
    });
  }

  // Opens a page in a window of this size.
  async open(url, {width = 1200, height = 800, dark = false, touch = false, downloads = this.home} = {}) {
    const {browserContextId} = await this.call("Target.createBrowserContext");
    const {targetId} = await this.call("Target.createTarget", {url: "about:blank", browserContextId, width, height});
    const {sessionId} = await this.call("Target.attachToTarget", {targetId, flatten: true});
    const page = new Page(this, sessionId, targetId);
    await this.call("Browser.setDownloadBehavior", {behavior: "allow", downloadPath: downloads, browserContextId});
    for (const domain of ["Page", "Runtime", "Log", "Network"]) await page.call(`${domain}.enable`);
    await page.call("Emulation.setDeviceMetricsOverride", {width, height, deviceScaleFactor: 1, mobile: width < 600});
    if (touch) await page.call("Emulation.setTouchEmulationEnabled", {enabled: true});
    await page.call("Emulation.setEmulatedMedia", {features: [{name: "prefers-color-scheme", value: dark ? "dark" : "light"}]});
    await page.go(url);
    return page;
  }

  async close() {
    const gone = new Promise((resolve) => this.child.on("exit", resolve));
    this.call("Browser.close").catch(() => {});  // it may go without an answer
    await Promise.race([gone, sleep(5000).then(() => this.child.kill("SIGKILL"))]);
    rmSync(this.home, {recursive: true, force: true, maxRetries: 10, retryDelay: 100});
  }
}

export class Page {
  constructor(browser, session, target) {
    this.browser = browser;
    this.session = session;
    this.target = target;
    this.errors = [];  // of the console
    browser.listeners.push((message) => {
      if (message.sessionId !== session) return;
      if (message.method === "Runtime.exceptionThrown") this.errors.push(message.params.exceptionDetails.exception?.description ?? message.params.exceptionDetails.text);
      if (message.method === "Log.entryAdded" && message.params.entry.level === "error") this.errors.push(message.params.entry.text);
      if (message.method === "Runtime.consoleAPICalled" && message.params.type === "error") this.errors.push(message.params.args.map((a) => a.description ?? a.value).join(" "));
    });
  }

  call(method, params = {}) {
    return this.browser.call(method, params, this.session);
  }

  // Returns once the page there is loaded.
  async go(url) {
    const loaded = new Promise((resolve) => this.browser.listeners.push((message) => {
      if (message.sessionId === this.session && message.method === "Page.loadEventFired") resolve();
    }));
    await this.call("Page.navigate", {url});
    await loaded;
  }

  async evaluate(expression) {
    const {result, exceptionDetails} = await this.call("Runtime.evaluate", {expression, awaitPromise: true, returnByValue: true});
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  until(expression, seconds) {
    return until(expression, () => this.evaluate(expression), seconds);
  }

  mouse(type, x, y, more = {}) {
    return this.call("Input.dispatchMouseEvent", {type, x, y, button: "left", buttons: 1, clickCount: 1, ...more});
  }

  // From one point of the page to another, in steps.
  async drag([x0, y0], [x1, y1], steps = 8, more = {}) {
    await this.mouse("mousePressed", x0, y0, more);
    for (let i = 1; i <= steps; ++i) {
      await this.mouse("mouseMoved", x0 + (x1 - x0) * i / steps, y0 + (y1 - y0) * i / steps, more);
      await sleep(20);
    }
    await this.mouse("mouseReleased", x1, y1, {...more, buttons: 0});
  }

  async press(key, more = {}) {
    const text = key.length === 1 ? key : undefined;
    await this.call("Input.dispatchKeyEvent", {type: "keyDown", key, text, ...more});
    await this.call("Input.dispatchKeyEvent", {type: "keyUp", key, ...more});
  }

  click(id) {
    return this.evaluate(`document.getElementById("${id}").click()`);
  }

  async screenshot(file) {
    const {data} = await this.call("Page.captureScreenshot", {format: "png"});
    writeFileSync(file, Buffer.from(data, "base64"));
  }
}
