// meshoptimizer from npm, with normals as attributes of weight 0.5 a component and no limit of error.
//
//   node meshoptimizer.mjs MODULES update|attributes IN OUT TRIANGLES
//
// Vertices are split by (position, normal), as its documentation asks. Prints the seconds of the
// library's call alone, by the wall clock and of the processor. The file format is that of exchange.h.
import fs from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';

const [modules, mode, inPath, outPath, target] = process.argv.slice(2);
const entry = path.join(modules, 'node_modules/meshoptimizer/meshopt_simplifier.js');
const { MeshoptSimplifier } = await import(pathToFileURL(entry));
await MeshoptSimplifier.ready;

const file = fs.readFileSync(inPath);
const buffer = file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength);
const [vertexCount, triangleCount] = new Uint32Array(buffer, 4, 3);
const positions = new Float64Array(buffer, 16, 3 * vertexCount);
const cornersAt = 16 + 24 * vertexCount;
const corners = new Uint32Array(buffer, cornersAt, 3 * triangleCount);
const normals = new Float32Array(buffer, cornersAt + 12 * triangleCount, 9 * triangleCount);
const normalBits = new Uint32Array(buffer, cornersAt + 12 * triangleCount, 9 * triangleCount);

// One vertex per (position, normal): a list of those that a position already has.
const splitOf = new Map();
const splitPosition = [], splitNormal = [];  // the source's vertex, the corner whose normal it has
const indices = new Uint32Array(3 * triangleCount);
for (let c = 0; c < corners.length; ++c) {
  let found = splitOf.get(corners[c]);
  if (found === undefined) splitOf.set(corners[c], (found = []));
  let split = found.find((s) => {
    const other = 3 * splitNormal[s];
    return normalBits[other] === normalBits[3 * c] && normalBits[other + 1] === normalBits[3 * c + 1] &&
        normalBits[other + 2] === normalBits[3 * c + 2];
  });
  if (split === undefined) {
    split = splitPosition.length;
    splitPosition.push(corners[c]);
    splitNormal.push(c);
    found.push(split);
  }
  indices[c] = split;
}
const p = new Float32Array(3 * splitPosition.length);
const n = new Float32Array(3 * splitPosition.length);
for (let s = 0; s < splitPosition.length; ++s) {
  for (let k = 0; k < 3; ++k) {
    p[3 * s + k] = positions[3 * splitPosition[s] + k];
    n[3 * s + k] = normals[3 * splitNormal[s] + k];
  }
}

const kWeights = [0.5, 0.5, 0.5], kNoLimit = 1e10;
const simplify =
    mode === 'update' ? MeshoptSimplifier.simplifyWithUpdate : MeshoptSimplifier.simplifyWithAttributes;
const start = performance.now(), processorStart = process.cpuUsage();
const [result] = simplify(indices, p, 3, n, 3, kWeights, null, 3 * Number(target), kNoLimit, []);
const seconds = (performance.now() - start) / 1000;
const processor = process.cpuUsage(processorStart);
const simplified = mode === 'update' ? indices.subarray(0, result) : result;

const outTriangles = simplified.length / 3;
// A split vertex that moved takes its twins along (meshoptimizer keeps equal positions equal), so
// positions are stored once per split vertex.
fs.writeFileSync(outPath, encode());
console.log(seconds.toFixed(6), ((processor.user + processor.system) / 1e6).toFixed(6));

function encode() {
  const used = new Map();
  for (const s of simplified) if (!used.has(s)) used.set(s, used.size);
  const size = 16 + 24 * used.size + 12 * outTriangles + 36 * outTriangles;
  const bytes = new ArrayBuffer(size);
  new Uint8Array(bytes).set([67, 82, 77, 88]);
  new Uint32Array(bytes, 4, 3).set([used.size, outTriangles, 1]);
  const q = new Float64Array(bytes, 16, 3 * used.size);
  for (const [s, at] of used) for (let k = 0; k < 3; ++k) q[3 * at + k] = p[3 * s + k];
  const after = 16 + 24 * used.size;
  const c = new Uint32Array(bytes, after, 3 * outTriangles);
  const m = new Float32Array(bytes, after + 12 * outTriangles, 9 * outTriangles);
  simplified.forEach((s, i) => {
    c[i] = used.get(s);
    for (let k = 0; k < 3; ++k) m[3 * i + k] = n[3 * s + k];
  });
  return new Uint8Array(bytes);
}
