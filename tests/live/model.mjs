// A small glTF file with what users' models have: a picture on a floor, and a pyramid that slides over it in a second.
import {writeFileSync} from "node:fs";

const checks = "iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAIAAAD91JpzAAAAFUlEQVR42mN4ZiP368MdBiCWs3kGADieCA0RIsZBAAAAAElFTkSuQmCC";  // 2x2 pixels, PNG

const floor = [-2, 0, 2, 2, 0, 2, 2, 0, -2, -2, 0, -2];
const corners = [0, 2, 2, 2, 2, 0, 0, 0];  // of the floor in its texture, which repeats
const pyramid = [-0.5, 0, 0.5, 0.5, 0, 0.5, 0, 1, 0, 0.5, 0, -0.5, -0.5, 0, -0.5];
const numbers = {SCALAR: 1, VEC2: 2, VEC3: 3};

// Writes the file as .glb: no camera, no light, one texture, one animation.
export function writeModel(file) {
  const views = [], accessors = [];
  let bytes = Buffer.alloc(0);
  const view = (data) => {
    views.push({buffer: 0, byteOffset: bytes.length, byteLength: data.length});
    bytes = Buffer.concat([bytes, data, Buffer.alloc(-data.length & 3)]);
    return views.length - 1;
  };
  const accessor = (type, values, more = {}) => accessors.push({
    bufferView: view(Buffer.from(Float32Array.from(values).buffer)), componentType: 5126, type,
    count: values.length / numbers[type], ...more}) - 1;
  const triangles = (values) => accessors.push({
    bufferView: view(Buffer.from(Uint16Array.from(values).buffer)), componentType: 5123, type: "SCALAR", count: values.length}) - 1;
  const mesh = (attributes, indices, material) => ({primitives: [{attributes, indices: triangles(indices), material}]});

  const document = {
    asset: {version: "2.0"}, scene: 0, scenes: [{nodes: [0, 1]}], nodes: [{mesh: 0}, {name: "Slider", mesh: 1}],
    meshes: [
      mesh({POSITION: accessor("VEC3", floor, {min: [-2, 0, -2], max: [2, 0, 2]}), TEXCOORD_0: accessor("VEC2", corners)}, [0, 1, 2, 0, 2, 3], 0),
      mesh({POSITION: accessor("VEC3", pyramid, {min: [-0.5, 0, -0.5], max: [0.5, 1, 0.5]})}, [0, 1, 2, 1, 3, 2, 3, 4, 2, 4, 0, 2], 1)],
    materials: [
      {pbrMetallicRoughness: {baseColorTexture: {index: 0}, metallicFactor: 0}},
      {pbrMetallicRoughness: {baseColorFactor: [0.1, 0.6, 0.2, 1], metallicFactor: 0}}],
    textures: [{source: 0}], images: [{mimeType: "image/png", bufferView: view(Buffer.from(checks, "base64"))}],
    animations: [{
      samplers: [{input: accessor("SCALAR", [0, 1], {min: [0], max: [1]}), output: accessor("VEC3", [-1.2, 0, 0, 1.2, 0, 0])}],
      channels: [{sampler: 0, target: {node: 1, path: "translation"}}]}],
    accessors, bufferViews: views, buffers: [{byteLength: bytes.length}]
  };
  const json = Buffer.from(JSON.stringify(document));
  const chunk = (type, data, fill) => {
    const padded = Buffer.concat([data, Buffer.alloc(-data.length & 3, fill)]);
    return Buffer.concat([Buffer.from(Uint32Array.of(padded.length, type).buffer), padded]);
  };
  const chunks = Buffer.concat([chunk(0x4e4f534a, json, " "), chunk(0x004e4942, bytes, 0)]);
  writeFileSync(file, Buffer.concat([Buffer.from(Uint32Array.of(0x46546c67, 2, 12 + chunks.length).buffer), chunks]));
}
