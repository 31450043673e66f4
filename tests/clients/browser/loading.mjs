// What several programs need to be loaded, or to load.

// A classic script, which leaves its names in the window.
export const script = (source) => new Promise((loaded, failed) => {
  const element = Object.assign(document.createElement('script'), {src: source, onload: loaded});
  element.onerror = () => failed(new Error(`${source} cannot be loaded`));
  document.head.append(element);
});

const base64 = (array) => new Promise((done) => {
  const reader = new FileReader();
  reader.onload = () => done(reader.result.replace(/^data:[^,]*/, 'data:application/octet-stream;base64'));
  reader.readAsDataURL(new Blob([array]));
});

// A glTF file, as text, with one white mesh that is as rough as can be and no metal.
export async function gltf({positions, normals, indices}, extras = {}) {
  const arrays = [positions, normals, indices], count = positions.length / 3;
  const bound = (choose) => [0, 1, 2].map((axis) => {
    let found = positions[axis];
    for (let i = axis; i < positions.length; i += 3) found = choose(found, positions[i]);
    return found;
  });
  return JSON.stringify({
    asset: {version: '2.0'},
    scene: 0,
    scenes: [{nodes: [0]}],
    nodes: [{mesh: 0}],
    meshes: [{primitives: [{attributes: {POSITION: 0, NORMAL: 1}, indices: 2, material: 0}]}],
    materials: [{pbrMetallicRoughness: {baseColorFactor: [1, 1, 1, 1], metallicFactor: 0, roughnessFactor: 1}}],
    buffers: await Promise.all(arrays.map(async (array) => ({byteLength: array.byteLength, uri: await base64(array)}))),
    bufferViews: arrays.map((array, i) => ({buffer: i, byteLength: array.byteLength, target: i < 2 ? 34962 : 34963})),
    accessors: [
      {bufferView: 0, componentType: 5126, count, type: 'VEC3', min: bound(Math.min), max: bound(Math.max)},
      {bufferView: 1, componentType: 5126, count, type: 'VEC3'},
      {bufferView: 2, componentType: 5125, count: indices.length, type: 'SCALAR'},
    ],
    ...extras,
  });
}
