'use strict';
// The engine, apart from the page so that the page never waits. Begins with {packed}, the engine in gzip and base64, then takes pictures, recipes and orders
// for cubes, one after another; answers {kind, id, ...}, or {kind: 'error', text}.
let engine = null, recipeSet = null;

function bytesOf(base64) {
  return Uint8Array.fromBase64 ? Uint8Array.fromBase64(base64) : Uint8Array.from(atob(base64), letter => letter.charCodeAt(0));
}

function checked(place) {
  const answer = JSON.parse(engine.UTF8ToString(place));
  if (answer.error !== undefined) throw new Error(answer.error);
  return answer;
}

function withText(text, call) {
  const size = engine.lengthBytesUTF8(text) + 1, place = engine._malloc(size);
  engine.stringToUTF8(text, place, size);
  try {
    return checked(call(place));
  } finally {
    engine._free(place);
  }
}

function setRecipe(recipe) {
  if (recipe === recipeSet) return;
  recipeSet = null;
  withText(recipe, engine._metamer_set);
  recipeSet = recipe;
}

const doors = {
  async begin({packed}) {
    engine = await new Promise((resolve, reject) => metamerEngine({
      instantiateWasm(imports, receive) {
        // Compiled while it is unpacked.
        const plain = new Response(bytesOf(packed)).body.pipeThrough(new DecompressionStream('gzip'));
        WebAssembly.instantiateStreaming(new Response(plain, {headers: {'Content-Type': 'application/wasm'}}), imports)
            .then(({instance, module}) => receive(instance, module)).catch(reject);
        return {};
      },
    }).then(resolve, reject));
    return {names: withText('/data', engine._metamer_open)};
  },
  picture({pixels}) {
    const at = engine._metamer_picture(pixels.length / 4);
    engine.HEAPU8.set(pixels, at);
    engine._metamer_decode();
    return {length: pixels.length};
  },
  // Without a length: what the picture will need, before it is there.
  show({recipe, tolerance, length}) {
    setRecipe(recipe);
    const answer = checked(engine._metamer_show(tolerance));
    return length === undefined ? {} : {pixels: engine.HEAPU8.slice(answer.at, answer.at + length)};
  },
  findings() {
    return {findings: checked(engine._metamer_findings())};
  },
  cube({space, size}) {
    return withText(space, place => engine._metamer_cube(place, size));
  },
};

async function serve(data) {
  const began = performance.now();
  try {
    const answer = await doors[data.kind](data);
    const moved = answer.pixels ? [answer.pixels.buffer] : [];
    postMessage({kind: data.kind, id: data.id, milliseconds: performance.now() - began, ...answer}, moved);
  } catch (error) {
    postMessage({kind: 'error', id: data.id, text: error.message || String(error)});
  }
}

let turn = Promise.resolve();
onmessage = ({data}) => turn = turn.then(() => serve(data));
