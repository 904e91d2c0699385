'use strict';
// The engine, apart from the page so that the page never waits. Begins with {module}, then takes pictures, recipes and orders
// for cubes; answers {kind, id, ...}, or {kind: 'error', text}.
let engine = null;

function textAt(place) {
  return JSON.parse(engine.UTF8ToString(place));
}

function withText(text, call) {
  const size = engine.lengthBytesUTF8(text) + 1, place = engine._malloc(size);
  engine.stringToUTF8(text, place, size);
  try {
    const answer = textAt(call(place));
    if (answer.error !== undefined) throw new Error(answer.error);
    return answer;
  } finally {
    engine._free(place);
  }
}

const doors = {
  async begin({module}) {
    engine = await new Promise((resolve, reject) => metamerEngine({
      instantiateWasm(imports, receive) {
        WebAssembly.instantiate(module, imports).then(instance => receive(instance, module)).catch(reject);
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
  recipe({recipe}) {
    return {findings: withText(recipe, engine._metamer_set)};
  },
  show({tolerance, length}) {
    const answer = textAt(engine._metamer_show(tolerance));
    if (answer.error !== undefined) throw new Error(answer.error);
    return {pixels: engine.HEAPU8.slice(answer.at, answer.at + length), tolerance};
  },
  cube({space, size}) {
    return withText(space, place => engine._metamer_cube(place, size));
  },
};

onmessage = async ({data}) => {
  const began = performance.now();
  try {
    const answer = await doors[data.kind](data);
    const moved = answer.pixels ? [answer.pixels.buffer] : [];
    postMessage({kind: data.kind, id: data.id, milliseconds: performance.now() - began, ...answer}, moved);
  } catch (error) {
    postMessage({kind: 'error', id: data.id, text: error.message || String(error)});
  }
};
