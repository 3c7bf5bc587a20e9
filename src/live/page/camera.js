// A camera as pprt's scripts have it: from, at, up, angle (degrees). All functions return a new one.

const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = (a) => Math.sqrt(dot(a, a));
const normalized = (a) => scale(a, 1 / length(a));

// About a unit axis, by an angle in radians (Rodrigues).
function turned(v, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return add(add(scale(v, c), scale(cross(axis, v), s)), scale(axis, dot(axis, v) * (1 - c)));
}

function axesOf(camera) {
  const forward = normalized(subtract(camera.at, camera.from));
  const right = normalized(cross(forward, camera.up));
  return {forward, right, up: cross(right, forward)};
}

// Round the point looked at, `right` and `up` in radians. The horizon stays level, short of straight up and down.
function orbited(camera, right, up) {
  const horizon = normalized(camera.up);
  const arm = turned(subtract(camera.from, camera.at), horizon, -right);
  const height = Math.asin(Math.max(-1, Math.min(1, dot(normalized(arm), horizon))));
  const limit = 1.55;
  const turn = Math.max(-limit, Math.min(limit, height + up)) - height;
  const aside = normalized(cross(horizon, arm));
  return {...camera, from: add(camera.at, turned(arm, aside, -turn))};
}

// Across the picture, in heights of the picture: what is looked at moves along with the pointer.
function panned(camera, right, up) {
  const axes = axesOf(camera);
  const distance = length(subtract(camera.at, camera.from));
  const height = 2 * distance * Math.tan(camera.angle * Math.PI / 360);
  const shift = add(scale(axes.right, -right * height), scale(axes.up, -up * height));
  return {...camera, from: add(camera.from, shift), at: add(camera.at, shift)};
}

// To the point looked at: 0.5 halves the distance.
function dollied(camera, factor) {
  return {...camera, from: add(camera.at, scale(subtract(camera.from, camera.at), factor))};
}

// The angle of view: 0.5 halves it.
function zoomed(camera, factor) {
  return {...camera, angle: Math.max(1, Math.min(150, camera.angle * factor))};
}

// The picture turns clockwise, in radians.
function rolled(camera, angle) {
  return {...camera, up: turned(axesOf(camera).up, axesOf(camera).forward, -angle)};
}

// All of a box in the picture, in the same direction. `aspect`: width of the picture by its height.
function framing(camera, [least, most], aspect) {
  const middle = scale(add(least, most), 0.5), radius = length(subtract(most, least)) / 2;
  const half = Math.atan(Math.tan(camera.angle * Math.PI / 360) * Math.min(1, aspect));
  const away = normalized(subtract(camera.from, camera.at));
  return {...camera, at: middle, from: add(middle, scale(away, Math.max(radius, 1e-9) / Math.sin(half)))};
}
