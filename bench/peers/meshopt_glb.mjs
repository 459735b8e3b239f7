// A mesh as a GLB with EXT_meshopt_compression, as gltfpack makes it: positions of 14 bits, normals
// of 10 bits a component (octahedral filter), vertices split by (position, normal). Positions of
// more than 16 bits, which KHR_mesh_quantization has not, are floats through the exponential
// filter, as with gltfpack -vpf.
//
//   node meshopt_glb.mjs MODULES IN OUT [POSITION_BITS NORMAL_BITS]
//
// Prints the bytes of the GLB and of the GLB after gzip -9, and writes the mesh that it holds to OUT.
// The file format is that of exchange.h.
import fs from 'node:fs';
import path from 'node:path';
import zlib from 'node:zlib';
import { pathToFileURL } from 'node:url';

const [modules, inPath, outPath, positionBits = '14', normalBits = '10'] = process.argv.slice(2);
const library = (file) =>
    import(pathToFileURL(path.join(modules, 'node_modules/meshoptimizer', file)));
const { MeshoptEncoder } = await library('meshopt_encoder.js');
const { MeshoptDecoder } = await library('meshopt_decoder.mjs');
await MeshoptEncoder.ready;
await MeshoptDecoder.ready;

const kPositionBits = Number(positionBits), kNormalBits = Number(normalBits);
const hasFloats = kPositionBits > 16;

const file = fs.readFileSync(inPath);
const buffer = file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength);
const [vertexCount, triangleCount] = new Uint32Array(buffer, 4, 3);
const positions = new Float64Array(buffer, 16, 3 * vertexCount);
const cornersAt = 16 + 24 * vertexCount;
const corners = new Uint32Array(buffer, cornersAt, 3 * triangleCount);
const normals = new Float32Array(buffer, cornersAt + 12 * triangleCount, 9 * triangleCount);

// The box, and its longest side in steps.
const low = [0, 1, 2].map((k) => positions.reduce((m, x, i) => (i % 3 === k ? Math.min(m, x) : m), Infinity));
const high = [0, 1, 2].map((k) => positions.reduce((m, x, i) => (i % 3 === k ? Math.max(m, x) : m), -Infinity));
const step = Math.max(...[0, 1, 2].map((k) => high[k] - low[k])) / ((1 << kPositionBits) - 1) || 1;

// Vertices: distinct pairs of quantized position and normal.
const numbers = new Map(), places = [], directions = [];
const indices = new Uint32Array(3 * triangleCount);
for (let c = 0; c < corners.length; ++c) {
  const place = [0, 1, 2].map((k) => Math.round((positions[3 * corners[c] + k] - low[k]) / step));
  const direction = [...normals.subarray(3 * c, 3 * c + 3)];
  const key = `${place},${direction.map((x) => Math.round(x * 1e6))}`;
  let number = numbers.get(key);
  if (number === undefined) {
    numbers.set(key, (number = places.length));
    places.push(place);
    directions.push(direction);
  }
  indices[c] = number;
}

// Triangles and vertices in the order that compresses best; reorderMesh() rewrites the indices.
const [remap, count] = MeshoptEncoder.reorderMesh(indices, true, true);
const width = hasFloats ? 3 : 4;  // of three, padded to four bytes where they are shorts
const coded = hasFloats ? new Float32Array(3 * count) : new Uint16Array(4 * count);
const vectors = new Float32Array(4 * count);
places.forEach((place, i) => {
  if (remap[i] === 0xffffffff) return;
  coded.set(hasFloats ? place.map((x) => x * step) : place, width * remap[i]);
  vectors.set(directions[i], 4 * remap[i]);
});
const filtered = MeshoptEncoder.encodeFilterOct(vectors, count, 8, kNormalBits);
const bytesOf = (array) => new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
const narrow = count <= 65536 ? new Uint16Array(indices) : indices;
const views = [
  positionView(),
  { data: MeshoptEncoder.encodeGltfBuffer(filtered, count, 8, 'ATTRIBUTES', 0), count, stride: 8, mode: 'ATTRIBUTES', filter: 'OCTAHEDRAL' },
  { data: MeshoptEncoder.encodeGltfBuffer(bytesOf(narrow), indices.length, narrow.BYTES_PER_ELEMENT, 'TRIANGLES', 0),
    count: indices.length, stride: narrow.BYTES_PER_ELEMENT, mode: 'TRIANGLES' },
];
const glb = pack();
console.log(glb.length, zlib.gzipSync(glb, { level: 9 }).length);
writeDecoded();

function positionView() {
  if (!hasFloats) {
    return { data: MeshoptEncoder.encodeGltfBuffer(bytesOf(coded), count, 8, 'ATTRIBUTES', 0), count, stride: 8, mode: 'ATTRIBUTES' };
  }
  const places = MeshoptEncoder.encodeFilterExp(coded, count, 12, Math.min(24, kPositionBits), 'SharedComponent');
  return { data: MeshoptEncoder.encodeGltfBuffer(places, count, 12, 'ATTRIBUTES', 0), count, stride: 12, mode: 'ATTRIBUTES', filter: 'EXPONENTIAL' };
}

function pack() {
  let at = 0, plain = 0;
  const bufferViews = views.map((v) => {
    const view = {
      buffer: 1, byteOffset: plain, byteLength: v.count * v.stride,
      extensions: { EXT_meshopt_compression: {
        buffer: 0, byteOffset: at, byteLength: v.data.length, byteStride: v.stride, count: v.count, mode: v.mode,
        ...(v.filter ? { filter: v.filter } : {}) } },
    };
    if (v.mode === 'ATTRIBUTES') view.byteStride = v.stride;
    at += (v.data.length + 3) & ~3;
    plain += (v.count * v.stride + 3) & ~3;
    return view;
  });
  const json = JSON.stringify({
    asset: { version: '2.0' },
    extensionsUsed: ['EXT_meshopt_compression', 'KHR_mesh_quantization'],
    extensionsRequired: ['EXT_meshopt_compression', 'KHR_mesh_quantization'],
    buffers: [{ byteLength: at }, { byteLength: plain, extensions: { EXT_meshopt_compression: { fallback: true } } }],
    bufferViews,
    accessors: [
      { bufferView: 0, componentType: hasFloats ? 5126 : 5123, count, type: 'VEC3', min: [0, 0, 0],
        max: [0, 1, 2].map((k) => Math.round((high[k] - low[k]) / step) * (hasFloats ? step : 1)) },
      { bufferView: 1, componentType: 5122, normalized: true, count, type: 'VEC3' },
      { bufferView: 2, componentType: narrow.BYTES_PER_ELEMENT === 2 ? 5123 : 5125, count: indices.length, type: 'SCALAR' },
    ],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, NORMAL: 1 }, indices: 2 }] }],
    nodes: [{ mesh: 0, translation: low, scale: Array(3).fill(hasFloats ? 1 : step) }],
    scenes: [{ nodes: [0] }], scene: 0,
  });
  const text = Buffer.from(json.padEnd((json.length + 3) & ~3, ' '));
  const bytes = Buffer.alloc(28 + text.length + at);
  bytes.write('glTF', 0);
  bytes.writeUInt32LE(2, 4);
  bytes.writeUInt32LE(bytes.length, 8);
  bytes.writeUInt32LE(text.length, 12);
  bytes.write('JSON', 16);
  text.copy(bytes, 20);
  bytes.writeUInt32LE(at, 20 + text.length);
  bytes.write('BIN\0', 24 + text.length);
  let offset = 28 + text.length;
  for (const v of views) {
    Buffer.from(v.data).copy(bytes, offset);
    offset += (v.data.length + 3) & ~3;
  }
  return bytes;
}

// What a viewer gets, decoded again.
function writeDecoded() {
  const [p, n, c] = views.map((v) => {
    const target = new Uint8Array(v.count * v.stride);
    MeshoptDecoder.decodeGltfBuffer(target, v.count, v.stride, v.data, v.mode, v.filter);
    return target;
  });
  const place = hasFloats ? new Float32Array(p.buffer) : new Uint16Array(p.buffer), direction = new Int16Array(n.buffer);
  const corner = narrow.BYTES_PER_ELEMENT === 2 ? new Uint16Array(c.buffer) : new Uint32Array(c.buffer);
  const after = 16 + 24 * count;
  const bytes = new ArrayBuffer(after + 48 * triangleCount);
  new Uint8Array(bytes).set([67, 82, 77, 88]);
  new Uint32Array(bytes, 4, 3).set([count, triangleCount, 1]);
  const q = new Float64Array(bytes, 16, 3 * count);
  for (let i = 0; i < count; ++i) for (let k = 0; k < 3; ++k) q[3 * i + k] = low[k] + (hasFloats ? 1 : step) * place[width * i + k];
  new Uint32Array(bytes, after, 3 * triangleCount).set(corner);
  const m = new Float32Array(bytes, after + 12 * triangleCount, 9 * triangleCount);
  corner.forEach((v, i) => {
    const d = direction.subarray(4 * v, 4 * v + 3);
    const length = Math.hypot(...d) || 1;
    for (let k = 0; k < 3; ++k) m[3 * i + k] = d[k] / length;
  });
  fs.writeFileSync(outPath, new Uint8Array(bytes));
}
