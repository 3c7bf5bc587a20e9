// The axes of the scene as the camera sees them.

class Cross {
  constructor(canvas) {
    this.canvas = canvas;
  }

  draw(camera) {
    const pixels = window.devicePixelRatio || 1, side = 64;
    this.canvas.width = this.canvas.height = side * pixels;
    const context = this.canvas.getContext("2d");
    context.scale(pixels, pixels);
    context.lineWidth = 2;
    context.font = "11px system-ui, sans-serif";
    context.textAlign = "center";
    context.textBaseline = "middle";
    const seen = axesOf(camera);
    const arms = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis, i) => ({
      name: "xyz"[i], color: ["#f2545b", "#3fb368", "#4d8dff"][i],
      right: dot(axis, seen.right), down: -dot(axis, seen.up), away: dot(axis, seen.forward)}));
    // What points at the eye is drawn last.
    arms.sort((a, b) => b.away - a.away);
    for (const arm of arms) {
      const x = side / 2 + 20 * arm.right, y = side / 2 + 20 * arm.down;
      context.strokeStyle = context.fillStyle = arm.color;
      context.globalAlpha = arm.away > 0.3 ? 0.6 : 1;
      context.beginPath();
      context.moveTo(side / 2, side / 2);
      context.lineTo(x, y);
      context.stroke();
      context.fillText(arm.name, side / 2 + 27 * arm.right, side / 2 + 27 * arm.down);
    }
  }
}
