// SPDX-License-Identifier: Apache-2.0
// The page of a light stage. relight_server.h describes what it asks for.
'use strict';

const byId = id => document.getElementById(id);
const canvas = byId('picture'), context = canvas.getContext('2d');
const names = ['probe', 'yaw', 'pitch', 'roll', 'exposure', 'tonemap'];
let asking = false, shown = '';

const choices = () => new URLSearchParams(names.map(id => [id, byId(id).value])).toString();

// One picture at a time; the choices made meanwhile are asked for together, when it has come.
async function update() {
  const wanted = choices();
  if (asking || wanted === shown) return;
  asking = true;
  const start = performance.now();
  try {
    const answer = await fetch('picture?' + wanted);
    if (!answer.ok) throw new Error(await answer.text());
    const pixels = new Uint8ClampedArray(await answer.arrayBuffer());
    context.putImageData(new ImageData(pixels, canvas.width), 0, 0);
    canvas.dataset.milliseconds = (performance.now() - start).toFixed(1);
    byId('time').textContent = `${canvas.dataset.milliseconds} ms for an update`;
    shown = wanted;
    canvas.dataset.shown = shown;
  } catch (error) {
    byId('time').textContent = error.message;
    return;
  } finally {
    asking = false;
  }
  update();
}

function showChoices() {
  for (const input of document.querySelectorAll('input'))
    input.nextElementSibling.textContent = input.value;
  byId('map').style.backgroundImage = `url("probe.png?probe=${byId('probe').value}")`;
  // A turn to the left, by which a map's columns move.
  byId('map').style.backgroundPositionX = `${-byId('yaw').value / 360 * byId('map').clientWidth}px`;
  update();
}

// A whole width of the element is `degrees` of yaw; the light follows the hand.
function turnByDragging(element, degrees) {
  element.addEventListener('pointerdown', event => element.setPointerCapture(event.pointerId));
  element.addEventListener('pointermove', event => {
    if (!event.buttons) return;
    const yaw = Number(byId('yaw').value) - event.movementX / element.clientWidth * degrees;
    byId('yaw').value = ((yaw + 540) % 360 + 360) % 360 - 180;
    showChoices();
  });
}

async function begin() {
  const stage = await (await fetch('stage.json')).json();
  canvas.width = stage.width;
  canvas.height = stage.height;
  byId('probe').replaceChildren(...stage.probes.map((name, i) => new Option(name, i)));
  for (const id of names) byId(id).addEventListener('input', showChoices);
  turnByDragging(canvas, 180);
  turnByDragging(byId('map'), 360);
  showChoices();
}

byId('stop').addEventListener('click', () => fetch('stop', {method: 'POST'})
    .then(() => { byId('time').textContent = 'stopped'; }).catch(() => {}));
begin().catch(error => { byId('time').textContent = error.message; });
