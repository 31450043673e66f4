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

// A program has
//   light(typed)      which has lines run that are typed to be lit, with the names that they take for given: `typed({scene})`;
//   around(line)      the line of a file, and what else has to be typed for it;
//   shape(geometry)   what is lit, white and matt;
//   look(view)        4 floats a pixel with rows from below;
// and some
//   usual()           their physically based material from there on;
//   surround(url)     a lat-long image around the camera;
//   project(url)      coefficients that they make of it themselves.
async function run(name) {
  const {open} = await import(`./programs/${name}.mjs`);
  const program = await open(document.getElementById('canvas'), SIZE);
  const normals = new Float32Array(await (await read('normals.f32')).arrayBuffer());
  const lit = (file, lines, more = {}) => program.light(async (names) => {
    const given = {...names, ...more, fetch: () => read(file)}; // whatever they fetch is the file
    await new AsyncFunction(...Object.keys(given), lines)(...Object.values(given));
  });
  const tiles = async (what) => {
    program.shape(quads(normals));
    await send(`${name}-${what}-tiles.f32`, await program.look({forward: [0, 0, -1], up: [0, 1, 0]}));
  };
  const views = async (what, more = {}) => {
    const floats = new Float32Array(VIEWS.length * SIZE * SIZE * 4);
    for (const [i, view] of VIEWS.entries()) floats.set(await program.look({...view, ...more}), i * SIZE * SIZE * 4);
    await send(`${name}-${what}.f32`, floats);
  };
  const file = `${name}.json`, {use} = await (await read(file)).json();
  await lit(file, `const json = await (await fetch('sky.json')).json();\n${program.around(use)}`);
  await tiles('use');
  const module = await import(`/job/${name}-module.js`), [, parameters] = String(module.apply).match(/\((.*?)\)/);
  await lit(file, program.around(`module.apply(${parameters})`), {module});
  await tiles('module');
  const guide = await (await read(`${name}-guide.js`)).text();
  for (const [from, what] of [[file, 'light'], [`${name}-constant.json`, 'constant']]) {
    await lit(from, guide);
    await tiles(what);
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
