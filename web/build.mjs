// Bundles the 3D view and writes it as a C++ source: node build.mjs OUT.cpp
import { build } from 'esbuild';
import { readFileSync, writeFileSync } from 'node:fs';

const DELIMITER = 'viewer';
const CHUNK = 8000; // characters of a string literal, so that the source stays readable for tools

// A raw string literal; adjacent ones are one string.
function literal(text) {
  if (text.includes(`)${DELIMITER}"`)) throw new Error('the delimiter of the raw strings is in the text');
  const chunks = [];
  for (let i = 0; i < text.length; i += CHUNK) {
    chunks.push(`R"${DELIMITER}(${text.slice(i, i + CHUNK)})${DELIMITER}"`);
  }
  return chunks.join('\n    ');
}

const release = JSON.parse(readFileSync('node_modules/three/package.json')).version.split('.')[1];
const licence = readFileSync('node_modules/three/LICENSE', 'utf8').trim();
const result = await build({
  entryPoints: ['src/viewer.js'],
  bundle: true,
  minify: true,
  write: false,
  format: 'iife',
  target: 'es2020',
  legalComments: 'none',
  banner: { js: `/*!\nthree.js r${release}\n\n${licence}\n*/` },
});
const script = result.outputFiles[0].text;
// What would end the element or change how a browser reads it.
if (/<\/script|<!--/i.test(script)) throw new Error('the bundle cannot stand in a script element');

writeFileSync(process.argv[2], `// Made by web/build.mjs; not to be edited.
#include "web/viewer.h"

namespace cellocut::web {

const Viewer& viewer() {
  static const Viewer kViewer{
    ${literal(script)},
    "three.js r${release}", "MIT",
    ${literal(licence)},
    ""};
  return kViewer;
}

}  // namespace cellocut::web
`);
console.log(`the 3D view: three.js r${release}, ${script.length} bytes`);
