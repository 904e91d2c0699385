'use strict';
// What is drawn beside the picture: the lights' spectra, and swatches of surfaces that are known.
const drawing = (() => {
  const svgNames = 'http://www.w3.org/2000/svg';

  function element(name, attributes, text) {
    const made = document.createElementNS(svgNames, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    if (text !== undefined) made.textContent = text;
    return made;
  }

  /** @param lights  two lists, 380 to 780 nm in even steps, 0 to 1. @param names  of the two */
  function spectra(svg, lights, names) {
    const left = 30, right = 352, top = 10, bottom = 150;
    const x = nm => left + (nm - 380) / 400 * (right - left), y = value => bottom - value * (bottom - top);
    svg.replaceChildren(element('title', {}, `Spectra of ${names[0]} and ${names[1]}, from 380 to 780 nanometres`));
    for (const value of [0, 0.5, 1]) {
      svg.append(element('path', {class: 'axis', d: `M${left} ${y(value)}H${right}`}),
          element('text', {x: left - 4, y: y(value) + 3, 'text-anchor': 'end'}, String(value)));
    }
    for (let nm = 400; nm <= 700; nm += 100) {
      svg.append(element('path', {class: 'axis', d: `M${x(nm)} ${bottom}v4`}),
          element('text', {x: x(nm), y: bottom + 16, 'text-anchor': 'middle'}, `${nm} nm`));
    }
    lights.forEach((values, k) => {
      const step = 400 / (values.length - 1);
      const points = values.map((value, i) => `${x(380 + i * step).toFixed(1)},${y(value).toFixed(1)}`).join(' ');
      svg.append(element('polyline', {class: `curve ${k === 0 ? 'one' : 'two'}`, points}));
    });
  }

  function code(linear) {
    const value = Math.min(1, Math.max(0, linear));
    return Math.round(255 * (value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055));
  }
  const colour = rgb => `rgb(${rgb.map(code).join(',')})`;

  /** A patch a surface: as shot above; below through the engine, the truth, plain adaptation. */
  function swatches(place, surfaces) {
    place.replaceChildren(...surfaces.map(surface => {
      const patch = document.createElement('div');
      patch.className = 'swatch';
      patch.title = `${surface.name}: ${surface.engineError.toFixed(1)} from the truth, plain adaptation ${surface.plainError.toFixed(1)}`;
      for (const kind of ['asShot', 'engine', 'truth', 'plain']) {
        const part = document.createElement('span');
        part.className = kind;
        part.style.background = colour(surface[kind]);
        patch.append(part);
      }
      return patch;
    }));
  }

  function table(body, surfaces) {
    body.replaceChildren(...surfaces.map(surface => {
      const row = document.createElement('tr'), head = document.createElement('th');
      head.scope = 'row';
      head.textContent = surface.name;
      row.append(head);
      for (const error of [surface.engineError, surface.plainError]) {
        const cell = document.createElement('td');
        cell.textContent = error.toFixed(1);
        row.append(cell);
      }
      return row;
    }));
  }

  return {spectra, swatches, table};
})();
