// SPDX-License-Identifier: Apache-2.0
// Linear pixels through the playground's engine:
//   node numbers.js FOLDER-OF-THE-ENGINE RECIPE.yaml PIXELS TOLERANCE
//   node numbers.js FOLDER-OF-THE-ENGINE RECIPE.yaml --cube SPACE SIZE
//   node numbers.js FOLDER-OF-THE-ENGINE RECIPE.yaml --times TOLERANCE OTHER.yaml...
// PIXELS: float32, red, green, blue, alpha; changed in place. TOLERANCE 0: the exact engine. The cube goes to stdout; so do
// milliseconds of processor time, as JSON: `times`, to begin and show a picture of 960 x 540, then to show it by each other recipe,
// of the thread that computes; `firstOfAll`, the first with the threads beside it, which compile. Prints what the engine says of
// the recipe otherwise, as JSON.
'use strict';
const fs = require('fs');
const [folder, recipeFile, ...order] = process.argv.slice(2);

const timeOfAll = () => process.cpuUsage().user / 1000;
const timeOfThread = () => Number(fs.readFileSync(`/proc/self/task/${process.pid}/schedstat`, 'utf8').split(' ')[0]) / 1e6;

async function main() {
  const shown = new Uint8Array(order[0] === '--times' ? 4 * 960 * 540 : 0).map((_, i) => (i * 2654435761 >>> 20) & 255);
  const began = timeOfThread(), beganOfAll = timeOfAll();
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
  answer(engine._metamer_set(given(fs.readFileSync(recipeFile, 'utf8'))));
  if (order[0] === '--cube') {
    process.stdout.write(answer(engine._metamer_cube(given(order[1]), Number(order[2]))).text);
    return;
  }
  if (order[0] === '--times') {
    const codes = engine._metamer_picture(960 * 540);
    engine.HEAPU8.set(shown, codes);
    engine._metamer_decode();
    let last = began, firstOfAll = 0;
    const times = [recipeFile, ...order.slice(2)].map((file, k) => {
      if (k > 0) answer(engine._metamer_set(given(fs.readFileSync(file, 'utf8'))));
      answer(engine._metamer_show(Number(order[1])));
      if (k === 0) firstOfAll = timeOfAll() - beganOfAll;
      const now = timeOfThread(), taken = now - last;
      last = now;
      return taken;
    });
    console.log(JSON.stringify({times, firstOfAll}));
    return;
  }
  const pixels = fs.readFileSync(order[0]), at = engine._malloc(pixels.length);
  engine.HEAPU8.set(pixels, at);
  answer(engine._metamer_apply(at, pixels.length / 16, Number(order[1])));
  fs.writeFileSync(order[0], engine.HEAPU8.subarray(at, at + pixels.length));
  console.log(JSON.stringify(answer(engine._metamer_findings())));
}

main().catch(error => {
  console.error(error.message);
  process.exit(1);
});
