'use strict';
const mostPixels = 960 * 540;
// CIEDE2000 that the fast map may be off by at its checked points: while a control moves, and once it rests. On photographs
// the first is off by 0.4 in the mean and 1.3 at the 99th percentile, the second by 0.04 and 0.3.
const whileMoving = 100, atRest = 0.3;
const restMilliseconds = 300;

const at = id => document.getElementById(id);
const controls = {in: at('in'), out: at('out'), gel: at('gel'), density: at('density'), adaptation: at('adaptation'), balanced: at('balanced')};
const before = at('before'), after = at('after'), status = at('status');

function say(text, isError = false) {
  status.textContent = text;
  status.classList.toggle('error', isError);
}

// ---- the engine, a call at a time ----
let worker = null, nextId = 0;
const waiting = new Map();

function ask(kind, body = {}, moved = []) {
  return new Promise((resolve, reject) => {
    const id = ++nextId;
    waiting.set(id, {resolve, reject});
    worker.postMessage({kind, id, ...body}, moved);
  });
}

function startWorker() {
  const made = new Worker(URL.createObjectURL(new Blob([at('worker-code').textContent], {type: 'text/javascript'})));
  made.onmessage = ({data}) => {
    const {resolve, reject} = waiting.get(data.id);
    waiting.delete(data.id);
    if (data.kind === 'error') reject(new Error(data.text)); else resolve(data);
  };
  made.onerror = event => say(`The engine stopped: ${event.message}`, true);
  return made;
}

// ---- the recipe ----
function quoted(text) {
  return JSON.stringify(text);
}

function recipeOf(chosen) {
  const gel = chosen.gel === '' ? '' : `filters: [{name: ${quoted(chosen.gel)}, density: ${chosen.density}}], `;
  return `metamer: 1
name: playground
space: Rec.709
input: {illuminant: ${quoted(chosen.in)}}
output: {illuminant: ${quoted(chosen.out)}, ${gel}adaptation: ${chosen.adaptation}}
balanced: ${chosen.balanced}
`;
}

function recipe() {
  return recipeOf(Object.fromEntries(Object.entries(controls).map(([name, control]) => [name, control.value])));
}

function nameOfOutput() {
  return controls.out.value + (controls.gel.value === '' ? '' : ` through ${controls.gel.value} × ${controls.density.value}`);
}

// ---- changes: the newest is shown, those that it overtook are not ----
let isShowing = false, isStale = false, restTimer = 0, pixelBytes = 0;

function tell(findings) {
  const surfaces = findings.surfaces;
  const mean = key => surfaces.reduce((sum, surface) => sum + surface[key], 0) / surfaces.length;
  drawing.spectra(at('spectra'), findings.lights, [controls.in.value, nameOfOutput()]);
  at('name-one').textContent = controls.in.value;
  at('name-two').textContent = nameOfOutput();
  drawing.swatches(at('swatches'), surfaces);
  drawing.table(at('figures'), surfaces);
  at('means').textContent = findings.identity ? 'Both lights are the same: nothing changes.'
      : `Mean difference from the truth (CIEDE2000): ${mean('engineError').toFixed(1)}; plain adaptation ${mean('plainError').toFixed(1)}.`;
  at('recipe').textContent = recipe();
}

async function show(tolerance) {
  const began = performance.now(), {width, height} = after;
  const {pixels} = await ask('show', {recipe: recipe(), tolerance, length: pixelBytes});
  // Another picture came, and will be shown by the change that it brings.
  if (after.width !== width || after.height !== height) return;
  after.getContext('2d').putImageData(new ImageData(new Uint8ClampedArray(pixels.buffer), width, height), 0, 0);
  const now = performance.now(), {dataset} = document.documentElement;
  dataset.first ??= now.toFixed(0);
  dataset.milliseconds = (now - began).toFixed(1);
  dataset.tolerance = tolerance;
  dataset.state = 'shown';
  say('');
  at('timing').textContent = `Shown in ${Math.round(now - began)} ms.`;
}

async function change() {
  clearTimeout(restTimer);
  for (const name of ['density', 'adaptation']) at(`${name}-value`).textContent = Number(controls[name].value).toFixed(2);
  controls.density.disabled = controls.gel.value === '';
  isStale = true;
  if (isShowing) return;
  isShowing = true;
  try {
    while (isStale) {
      isStale = false;
      await show(whileMoving);
      if (!isStale) tell((await ask('findings')).findings);
    }
    document.documentElement.dataset.state = 'ready';
  } catch (error) {
    document.documentElement.dataset.state = 'error';
    say(error.message, true);
    return;
  } finally {
    isShowing = false;
  }
  restTimer = setTimeout(rest, restMilliseconds);
}

async function rest() {
  isShowing = true;
  try {
    await show(atRest);
    document.documentElement.dataset.state = 'rest';
  } catch (error) {
    say(error.message, true);
  }
  isShowing = false;
  if (isStale) change();
}

// ---- pictures ----
async function takePicture(source, name) {
  const picture = await createImageBitmap(source);
  const scale = Math.min(1, Math.sqrt(mostPixels / (picture.width * picture.height)));
  const width = Math.max(1, Math.floor(picture.width * scale)), height = Math.max(1, Math.floor(picture.height * scale));
  for (const canvas of [before, after]) {
    canvas.width = width;
    canvas.height = height;
  }
  const context = before.getContext('2d', {willReadFrequently: true});
  context.imageSmoothingQuality = 'high';
  context.drawImage(picture, 0, 0, width, height);
  const {data} = context.getImageData(0, 0, width, height);
  pixelBytes = data.length;
  await ask('picture', {pixels: data});
  at('pair').style.setProperty('--ratio', width / height);
  at('picture-name').textContent = `${name}, ${width} × ${height}`;
}

async function takeFile(file) {
  try {
    await takePicture(file, file.name);
  } catch {
    say(`${file.name} is no picture that this browser reads; give it a JPEG, PNG or WebP.`, true);
    return;
  }
  await change();
}

function split() {
  const value = at('split').value;
  at('pair').style.setProperty('--at', value + '%');
  at('split').setAttribute('aria-valuetext', `${value} % before, ${100 - value} % after`);
}

// ---- files ----
function save(text, name) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob([text], {type: 'text/plain'}));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

async function saveCube() {
  const space = at('space').value, size = Number(at('size').value);
  say('Making the cube …');
  try {
    const {text, milliseconds} = await ask('cube', {space, size});
    save(text, `${controls.in.value} to ${controls.out.value}, ${space}.cube`.replace(/[^\w ,.+-]/g, '_'));
    document.documentElement.dataset.cube = text.length;
    say(`The cube was made in ${Math.round(milliseconds)} ms, from the exact engine.`);
  } catch (error) {
    say(error.message, true);
  }
}

// ---- beginning ----
function fill(select, entries, chosen) {
  for (const {name, text} of entries) {
    const option = new Option(text ? `${name}: ${text}` : name, name, false, name === chosen);
    select.add(option);
  }
}

// ---- what the page begins with: where it stands within a report, the report's recipe ----
function begun(name, otherwise, entries) {
  const said = document.documentElement.dataset[`start${name[0].toUpperCase()}${name.slice(1)}`];
  return said === undefined || (entries && !entries.some(entry => entry.name === said)) ? otherwise : said;
}

const usual = {in: 'D65', out: 'HP1', gel: ''};

// The engine begins with the recipe while the page is still busy with the photograph and the names.
async function begin() {
  worker = startWorker();
  const photograph = fetch(at('photograph').src).then(given => given.blob());
  const opened = ask('begin', {packed: at('engine-code').textContent.trim()});
  for (const name of ['density', 'adaptation']) controls[name].value = begun(name, controls[name].value);
  const chosen = {density: controls.density.value, adaptation: controls.adaptation.value, balanced: controls.balanced.value};
  for (const name in usual) chosen[name] = begun(name, usual[name]);
  // Where a report's names are none of the page's, the usual ones are taken below.
  ask('show', {recipe: recipeOf(chosen), tolerance: whileMoving}).catch(() => {});
  await takePicture(await photograph, 'The photograph that comes with the page');
  const {names} = await opened;
  fill(controls.in, names.illuminants, begun('in', usual.in, names.illuminants));
  fill(controls.out, names.illuminants, begun('out', usual.out, names.illuminants));
  fill(controls.gel, names.filters, begun('gel', usual.gel, names.filters));
  fill(at('space'), names.spaces.map(name => ({name})), 'ACEScct');
  for (const control of Object.values(controls)) control.addEventListener('input', change);
  at('split').addEventListener('input', split);
  at('file').addEventListener('change', event => event.target.files[0] && takeFile(event.target.files[0]));
  at('save-cube').addEventListener('click', saveCube);
  at('save-recipe').addEventListener('click', () => save(recipe(), 'playground.yaml'));
  addEventListener('dragover', event => event.preventDefault());
  addEventListener('drop', event => {
    event.preventDefault();
    if (event.dataTransfer.files[0]) takeFile(event.dataTransfer.files[0]);
  });
  split();
  await change();
}

begin().catch(error => say(`This page needs a browser of 2023 or newer, with WebAssembly: ${error.message}`, true));
