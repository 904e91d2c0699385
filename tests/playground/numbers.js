// SPDX-License-Identifier: Apache-2.0
// Linear pixels through the playground's engine:
//   node numbers.js FOLDER-OF-THE-ENGINE RECIPE.yaml PIXELS TOLERANCE
//   node numbers.js FOLDER-OF-THE-ENGINE RECIPE.yaml --cube SPACE SIZE
// PIXELS: float32, red, green, blue, alpha; changed in place. TOLERANCE 0: the exact engine. The cube goes to stdout. Prints what
// the engine says of the recipe otherwise, as JSON.
'use strict';
const fs = require('fs');
const [folder, recipeFile, ...order] = process.argv.slice(2);

async function main() {
  const engine = await require(`${folder}/engine.js`)({wasmBinary: fs.readFileSync(`${folder}/engine.wasm`)});
  const given = text => {
    const size = engine.lengthBytesUTF8(text) + 1, place = engine._malloc(size);
    engine.stringToUTF8(text, place, size);
    return place;
  };
  const answer = place => {
    const said = JSON.parse(engine.UTF8ToString(place));
    if (said.error !== undefined) throw new Error(said.error);
    return said;
  };
  answer(engine._metamer_open(given('/data')));
  const findings = answer(engine._metamer_set(given(fs.readFileSync(recipeFile, 'utf8'))));
  if (order[0] === '--cube') {
    process.stdout.write(answer(engine._metamer_cube(given(order[1]), Number(order[2]))).text);
    return;
  }
  const pixels = fs.readFileSync(order[0]), at = engine._malloc(pixels.length);
  engine.HEAPU8.set(pixels, at);
  answer(engine._metamer_apply(at, pixels.length / 16, Number(order[1])));
  fs.writeFileSync(order[0], engine.HEAPU8.subarray(at, at + pixels.length));
  console.log(JSON.stringify(findings));
}

main().catch(error => {
  console.error(error.message);
  process.exit(1);
});
