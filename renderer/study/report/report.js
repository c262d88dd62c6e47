// SPDX-License-Identifier: Apache-2.0
// The interactive parts of the report: images to divide and flip, maps to read. report.h
// describes `data`.
'use strict';

const byId = id => document.getElementById(id);
const tip = byId('tip');

function showTip(event, text) {
  tip.textContent = text;
  tip.style.display = text ? 'block' : 'none';
  tip.style.left = Math.min(event.clientX + 14, innerWidth - tip.offsetWidth - 8) + 'px';
  tip.style.top = Math.min(event.clientY + 14, innerHeight - tip.offsetHeight - 8) + 'px';
}

// The bytes (RGBA) of a PNG data URI.
async function pixelsOf(uri, width, height) {
  const image = new Image();
  image.src = uri;
  await image.decode();
  const canvas = document.createElement('canvas');
  canvas.width = width;
  canvas.height = height;
  const context = canvas.getContext('2d', {willReadFrequently: true});
  context.drawImage(image, 0, 0);
  return context.getImageData(0, 0, width, height).data;
}

// Radiance, three floats per pixel, from mantissas and exponents.
async function radianceOf(image) {
  const [rgb, exponent] = await Promise.all(
      [image.rgb, image.exponent].map(uri => pixelsOf(uri, data.width, data.height)));
  const radiance = new Float32Array(3 * data.width * data.height);
  for (let i = 0; i < data.width * data.height; ++i) {
    const scale = exponent[4 * i] ? 2 ** (exponent[4 * i] - 136) : 0;
    for (let c = 0; c < 3; ++c) radiance[3 * i + c] = (rgb[4 * i + c] + 0.5) * scale;
  }
  return radiance;
}

const srgb = x => x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055;

function toScreen(radiance, stops) {
  const image = new ImageData(data.width, data.height);
  const gain = 2 ** stops;
  for (let i = 0; i < data.width * data.height; ++i) {
    for (let c = 0; c < 3; ++c)
      image.data[4 * i + c] = 255 * srgb(Math.min(1, radiance[3 * i + c] * gain)) + 0.5;
    image.data[4 * i + 3] = 255;
  }
  return image;
}

function pixelUnder(event, element, width, height) {
  const box = element.getBoundingClientRect();
  return {
    x: Math.min(width - 1, Math.max(0, Math.floor((event.clientX - box.left) / box.width * width))),
    y: Math.min(height - 1,
                Math.max(0, Math.floor((event.clientY - box.top) / box.height * height))),
    fraction: Math.min(1, Math.max(0, (event.clientX - box.left) / box.width))
  };
}

async function makeViewer() {
  const label = p => `${p.name}, ${+p.samples.toPrecision(4)} samples, ${p.seconds.toPrecision(3)} s`;
  const images = await Promise.all([data.reference, ...data.images].map(
      async p => ({label: p.name ? label(p) : 'reference', radiance: await radianceOf(p)})));
  const canvas = document.querySelector('#viewer canvas'), context = canvas.getContext('2d');
  canvas.width = data.width;
  canvas.height = data.height;
  const zoom = Math.max(1, Math.floor(Math.min(1100, document.body.clientWidth - 48) / data.width));
  canvas.style.width = data.width * Math.min(zoom, 5) + 'px';

  const choices = [byId('imageA'), byId('imageB')];
  choices.forEach((choice, i) => {
    for (const p of images) choice.add(new Option(p.label));
    choice.selectedIndex = i ? 0 : Math.min(1, images.length - 1);
  });
  let fraction = 0.5, flipped = null;  // flipped: 0 or 1 if one image fills the frame
  const screens = [null, null];
  const chosen = i => images[choices[i].selectedIndex];

  function draw() {
    const edge = flipped === null ? Math.round(fraction * data.width) : flipped ? 0 : data.width;
    context.putImageData(screens[0], 0, 0, 0, 0, edge, data.height);
    context.putImageData(screens[1], 0, 0, edge, 0, data.width - edge, data.height);
    byId('divider').style.left = 100 * edge / data.width + '%';
    byId('nameA').textContent = edge > 0 ? chosen(0).label : '';
    byId('nameB').textContent = edge < data.width ? chosen(1).label : '';
  }
  function expose() {
    const stops = +byId('exposure').value;
    byId('stops').textContent = (stops > 0 ? '+' : '') + stops + ' stops';
    for (const i of [0, 1]) screens[i] = toScreen(chosen(i).radiance, stops);
    draw();
  }
  function flip() {
    flipped = flipped === 0 ? 1 : 0;
    draw();
  }
  byId('exposure').oninput = expose;
  for (const choice of choices) choice.onchange = expose;
  byId('flip').onclick = flip;
  addEventListener('keydown', event => {
    if (event.key !== ' ' || /SELECT|BUTTON|INPUT/.test(event.target.tagName)) return;
    event.preventDefault();
    flip();
  });
  canvas.onmousemove = event => {
    const at = pixelUnder(event, canvas, data.width, data.height), i = 3 * (at.y * data.width + at.x);
    const line = p => [0, 1, 2].map(c => p.radiance[i + c].toPrecision(3).padStart(9)).join(' ');
    const error = p => {
      let sum = 0;
      for (let c = 0; c < 3; ++c) {
        const truth = images[0].radiance[i + c];
        sum += (p.radiance[i + c] - truth) ** 2 / (truth ** 2 + 0.01) / 3;
      }
      return (100 * Math.sqrt(sum)).toPrecision(2) + '%';
    };
    fraction = at.fraction;
    flipped = null;
    draw();
    showTip(event, `pixel ${at.x}, ${at.y}\nreference ${line(images[0])}\n` +
        [0, 1].map(k => `${k ? 'right    ' : 'left     '} ${line(chosen(k))}  error ${error(chosen(k))}`)
            .join('\n'));
  };
  canvas.onmouseleave = event => showTip(event, '');
  expose();
}

// A map in false colours; `read` describes the level of a pixel.
async function makeMap(parent, uri, width, height, colors, caption, read) {
  const figure = document.createElement('figure'), canvas = document.createElement('canvas');
  canvas.width = width;
  canvas.height = height;
  figure.append(canvas, document.createElement('figcaption'));
  figure.lastChild.append(...caption);
  parent.append(figure);
  const levels = await pixelsOf(uri, width, height), image = new ImageData(width, height);
  for (let i = 0; i < width * height; ++i)
    image.data.set([...colors[levels[4 * i]], 255], 4 * i);
  canvas.getContext('2d').putImageData(image, 0, 0);
  canvas.onmousemove = event => {
    const at = pixelUnder(event, canvas, width, height);
    showTip(event, read(levels[4 * (at.y * width + at.x)], at));
  };
  canvas.onmouseleave = event => showTip(event, '');
}

function makeLegend(id, colors, from, to) {
  const canvas = document.createElement('canvas');
  canvas.width = 256;
  canvas.height = 1;
  const image = new ImageData(256, 1);
  colors.forEach((color, i) => image.data.set([...color, 255], 4 * i));
  canvas.getContext('2d').putImageData(image, 0, 0);
  byId(id).append(from, canvas, to);
}

const bold = text => Object.assign(document.createElement('b'), {textContent: text});
const percent = x => +(100 * x).toPrecision(2) + '%';

// Maps are decoded concurrently.
async function makeMaps() {
  const maps = [];
  const {max, decades} = data.errorScale;
  makeLegend('errorLegend', data.heat, percent(max / 10 ** decades) + ' or less', percent(max));
  for (const p of data.images)
    maps.push(makeMap(
        byId('errors'), p.error, data.width, data.height, data.heat,
        [bold(p.name), ` ${p.seconds.toPrecision(3)} s, ${p.budget}`],
        (level, at) => `pixel ${at.x}, ${at.y}\nerror ` +
            (level ? percent(max * 10 ** ((level / 255 - 1) * decades)) : 'below the scale')));

  byId('biasPart').hidden = data.bias.length === 0;
  makeLegend('biasLegend', data.signed, '-' + percent(data.biasScale.max),
             '+' + percent(data.biasScale.max));
  for (const b of data.bias)
    maps.push(makeMap(
        byId('bias'), b.map, data.width, data.height, data.signed,
        [bold(b.name), ` ${b.budget}`],
        (level, at) => `pixel ${at.x}, ${at.y}\n` +
            (level === 128 ? 'bias not significant'
                           : 'bias ' + percent((level - 128) / 127 * data.biasScale.max))));

  byId('zLegend').hidden = data.pairs.length === 0;
  makeLegend('zLegend', data.signed, `z = -${data.zScale}`, `+${data.zScale}`);
  for (const p of data.pairs)
    maps.push(makeMap(
        byId('z'), p.map, p.width, p.height, data.signed, [bold(`${p.a} - ${p.b}`)],
        (level, at) => `tile ${at.x}, ${at.y}\nz ` +
            ((level - 128) / 127 * data.zScale).toFixed(1)));
  await Promise.all(maps);
}

Promise.all([makeViewer(), makeMaps()]).then(() => document.body.dataset.ready = 'yes');
