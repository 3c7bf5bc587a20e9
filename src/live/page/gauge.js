// The figures of the last frames.

class Gauge {
  static kFrames = 120;

  constructor(canvas, text) {
    this.canvas = canvas;
    this.text = text;
    this.frames = [];
  }

  forget() {
    this.frames = [];
  }

  // `rate`: frames/s
  add(frames, rate) {
    this.frames = this.frames.concat(frames).slice(-Gauge.kFrames);
    this.draw(1000 / rate);
  }

  draw(period) {
    const {canvas, frames} = this;
    const pixels = window.devicePixelRatio || 1;
    canvas.width = canvas.clientWidth * pixels;
    canvas.height = canvas.clientHeight * pixels;
    const style = getComputedStyle(canvas);
    const context = canvas.getContext("2d");
    const middle = canvas.height * 0.6, wide = canvas.width / Gauge.kFrames;
    // A slack of half a period reaches the top, a delay of a period the bottom.
    frames.forEach((frame, i) => {
      const early = frame.slack_ms >= 0;
      const share = Math.min(1, Math.abs(frame.slack_ms) / (early ? period / 2 : period));
      const high = Math.max(pixels, share * (early ? middle : canvas.height - middle));
      context.fillStyle = style.getPropertyValue(early ? "--good" : "--bad");
      context.fillRect(i * wide, early ? middle - high : middle, Math.max(1, wide - 1), high);
    });
    context.fillStyle = style.getPropertyValue("--line");
    context.fillRect(0, middle, canvas.width, pixels);
    const late = frames.filter((frame) => frame.slack_ms < 0).length;
    const least = Math.min(...frames.map((frame) => frame.slack_ms));
    this.text.textContent = `${frames.length - late} of ${frames.length} on time, ` +
      (least < 0 ? `the latest by ${(-least).toFixed(1)} ms` : `by ${least.toFixed(1)} ms at least`);
  }
}

// How long it takes until a camera that was sent is seen.
class Lag {
  constructor() {
    this.sent = [];  // [look, milliseconds]
    this.seen = [];  // milliseconds, the last 60
  }

  send(look, now) {
    this.sent.push([look, now]);
  }

  // A frame with this look is on the screen.
  show(look, now) {
    while (this.sent.length > 0 && this.sent[0][0] <= look) {
      const [number, then] = this.sent.shift();
      this.seen = this.seen.concat(now - then).slice(-60);
    }
  }

  forget() {
    this.sent = [];
    this.seen = [];
  }

  median() {
    const sorted = [...this.seen].sort((a, b) => a - b);
    return sorted.length > 0 ? sorted[Math.floor(sorted.length / 2)] : null;
  }
}
