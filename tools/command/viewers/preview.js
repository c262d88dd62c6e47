// SPDX-License-Identifier: Apache-2.0
// The page of a render in progress. preview_server.h describes what it asks for.
'use strict';

const byId = id => document.getElementById(id);
const picture = byId('picture'), tip = byId('tip');
let render = {image: 0}, shown = '', asking = false;

const clock = seconds => {
  const s = Math.ceil(seconds), two = n => String(n).padStart(2, '0');
  return s < 3600 ? `${Math.floor(s / 60)}:${two(s % 60)}`
                  : `${Math.floor(s / 3600)}:${two(Math.floor(s / 60) % 60)}:${two(s % 60)}`;
};

function progressText() {
  const parts = [];
  if (render.samples !== undefined) parts.push(`${render.samples} samples`);
  if (typeof render.noise === 'number') parts.push(`noise ${(100 * render.noise).toPrecision(2)}%`);
  parts.push(`${clock(render.elapsed)} elapsed`);
  if (render.isLast) parts.push('finished');
  else if (typeof render.remaining === 'number') parts.push(`${clock(render.remaining)} remaining`);
  if (render.filesWritten) parts.push('saved');
  return parts.join(', ');
}

function listLayers() {
  const select = byId('layer'), names = render.layers || [];
  if (names.join() === [...select.options].map(o => o.value).join()) return;
  const before = select.value;
  select.replaceChildren(...names.map(name => new Option(name || 'color', name)));
  select.value = names.includes(before) ? before : '';
}

// The image of the present choices, if it is not shown yet.
async function refresh() {
  if (!render.image) return;
  const zoom = Number(byId('zoom').value);
  const choices = new URLSearchParams({
    layer: byId('layer').value, tonemap: byId('tonemap').value, exposure: byId('exposure').value,
    width: zoom ? 0 : Math.ceil(document.querySelector('main').clientWidth * devicePixelRatio),
    image: render.image  // tells the images of a render apart
  }).toString();
  if (choices === shown) return;
  shown = choices;
  const answer = await fetch('image.png?' + choices);
  if (!answer.ok || choices !== shown) return;
  const url = URL.createObjectURL(await answer.blob());
  picture.onload = () => {
    URL.revokeObjectURL(url);
    picture.dataset.image = answer.headers.get('X-Image');
  };
  picture.src = url;
  picture.classList.toggle('fit', !zoom);
  picture.style.width = zoom ? zoom * render.width + 'px' : '';
}

async function poll() {
  try {
    render = await (await fetch('status.json')).json();
    byId('name').textContent = render.name;
    document.title = `${Math.floor(100 * (render.fraction || 0))}% ${render.name}`;
    byId('progress').textContent = progressText();
    byId('done').style.width = 100 * (render.fraction || 0) + '%';
    listLayers();
    await refresh();
  } catch {
    byId('progress').textContent =
        render.isLast ? progressText() : 'the render has ended, or cannot be reached';
    for (const id of ['save', 'stop', 'layer', 'tonemap', 'exposure']) byId(id).disabled = true;
  }
  setTimeout(poll, 500);
}

// The pixel's coordinates in the whole image, and its value in each layer.
async function showValues(event) {
  if (asking) return;
  asking = true;
  const box = picture.getBoundingClientRect();
  const along = (at, from, length, count) =>
      Math.min(count - 1, Math.max(0, Math.floor((at - from) / length * count)));
  const x = along(event.clientX, box.left, box.width, render.width);
  const y = along(event.clientY, box.top, box.height, render.height);
  const answer = await fetch(`pixel.json?x=${x}&y=${y}`).finally(() => { asking = false; });
  if (!answer.ok) return;
  const values = Object.entries(await answer.json());
  const width = Math.max(...values.map(([name]) => (name || 'color').length));
  tip.textContent = [`pixel ${x + render.left}, ${y + render.top}`].concat(
      values.map(([name, v]) => `${(name || 'color').padEnd(width)}  ${v.join('  ')}`)).join('\n');
  tip.style.display = 'block';
  tip.style.left = Math.max(0, Math.min(event.clientX + 14, innerWidth - tip.offsetWidth - 8)) + 'px';
  tip.style.top = Math.max(0, Math.min(event.clientY + 14, innerHeight - tip.offsetHeight - 8)) + 'px';
}

picture.addEventListener('mousemove', event => showValues(event).catch(() => {}));
picture.addEventListener('mouseleave', () => { tip.style.display = 'none'; });
for (const id of ['layer', 'tonemap', 'exposure', 'zoom'])
  byId(id).addEventListener('input', () => {
    byId('stops').textContent = byId('exposure').value;
    refresh().catch(() => {});
  });
for (const id of ['save', 'stop'])
  byId(id).addEventListener('click', () => fetch(id, {method: 'POST'}).then(async answer => {
    if (answer.ok) return;
    byId(id).disabled = true;
    byId(id).title = await answer.text();
  }).catch(() => {}));
poll();
