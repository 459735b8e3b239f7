// Holds GLB files against the Khronos glTF validator: no error, no warning.
//
//   node validate_gltf.js FOLDER        every .glb in it; exit 1 if one has an issue or there is none
'use strict';

const fs = require('fs');
const path = require('path');
const validator = require('gltf-validator');

const WARNING = 1;  // severities: 0 error, 1 warning, 2 information, 3 hint

async function main(folder) {
  const files = fs.readdirSync(folder).filter((name) => name.endsWith('.glb')).sort();
  let bad = 0;
  for (const name of files) {
    const bytes = new Uint8Array(fs.readFileSync(path.join(folder, name)));
    const report = await validator.validateBytes(bytes, {uri: name, maxIssues: 0});
    const issues = report.issues.messages.filter((issue) => issue.severity <= WARNING);
    for (const issue of issues.slice(0, 10)) {
      console.log(`${name}: ${issue.code} at ${issue.pointer || issue.offset}: ${issue.message}`);
    }
    if (issues.length > 0 || report.info.totalTriangleCount === 0) ++bad;
  }
  console.log(`${files.length} files, ${bad} with errors or warnings`);
  return files.length > 0 && bad === 0 ? 0 : 1;
}

main(process.argv[2]).then((code) => process.exit(code), (error) => {
  console.error(error);
  process.exit(1);
});
