// Runs one program in a browser, as ?program=NAME: what it is asked to draw is in /job/, what it draws is sent there.
import {quads, sphere} from './geometry.mjs';

const SIZE = 128; // pixels of a view along each side
// The six ways a camera looks, and what is up for it, in the program's own axes.
const VIEWS = [
  {forward: [1, 0, 0], up: [0, 1, 0]}, {forward: [-1, 0, 0], up: [0, 1, 0]},
  {forward: [0, 1, 0], up: [0, 0, 1]}, {forward: [0, -1, 0], up: [0, 0, 1]},
  {forward: [0, 0, 1], up: [0, 1, 0]}, {forward: [0, 0, -1], up: [0, 1, 0]},
];

const read = async (name) => {
  const answer = await fetch(`/job/${name}`);
  if (!answer.ok) throw new Error(`${name}: ${answer.status}`);
  return answer;
};
const AsyncFunction = (async () => {}).constructor;
const send = (name, body) => fetch(`/job/${name}`, {method: 'POST', body});

// A program has `light(typed)`, which has the guide's lines run with the names that they take for given: `typed({scene})`;
// `shape(geometry)`, what is lit, white and matt; `look(view)`, 4 floats a pixel with rows from below. Some have `usual()`, their physically based material from there on;
// `surround(url)`, a lat-long image around the camera; `project(url)`, coefficients that they make of it themselves.
async function run(name) {
  const {open} = await import(`./programs/${name}.mjs`);
  const program = await open(document.getElementById('canvas'), SIZE);
  const normals = new Float32Array(await (await read('normals.f32')).arrayBuffer());
  const lines = await (await read(`${name}.js`)).text();
  const lit = (file) => program.light(async (names) => {
    const typed = new AsyncFunction('fetch', ...Object.keys(names), lines);
    await typed(() => read(file), ...Object.values(names)); // whatever they fetch is the file
  });
  const views = async (what, more = {}) => {
    const floats = new Float32Array(VIEWS.length * SIZE * SIZE * 4);
    for (const [i, view] of VIEWS.entries()) floats.set(await program.look({...view, ...more}), i * SIZE * SIZE * 4);
    await send(`${name}-${what}.f32`, floats);
  };
  for (const [file, what] of [[`${name}.json`, 'light'], [`${name}-constant.json`, 'constant']]) {
    await lit(file);
    program.shape(quads(normals));
    await send(`${name}-${what}-tiles.f32`, await program.look({forward: [0, 0, -1], up: [0, 1, 0]}));
    program.shape(sphere());
    await views(`${what}-sphere`);
  }
  if (program.usual) {
    program.usual();
    await views('usual-sphere');
  }
  if (program.surround) {
    await program.surround('/job/light.hdr');
    await views('surroundings', {inside: true});
  }
  if (program.project) await send(`${name}-own.json`, JSON.stringify(await program.project('/job/light.hdr')));
}

window.finished = run(new URLSearchParams(location.search).get('program'));
