// What is lit: {positions, normals, indices}, counter-clockwise as seen from outside in right-handed axes.

// A unit sphere, dense enough that its flat triangles are not seen.
export function sphere(rows = 128, columns = 256) {
  const normals = [], indices = [];
  for (let i = 0; i <= rows; i++) {
    for (let j = 0; j <= columns; j++) {
      const theta = Math.PI * i / rows, phi = 2 * Math.PI * j / columns;
      normals.push(Math.sin(theta) * Math.cos(phi), Math.sin(theta) * Math.sin(phi), Math.cos(theta));
      if (i < rows && j < columns) {
        const at = i * (columns + 1) + j, below = at + columns + 1;
        indices.push(at, below, at + 1, at + 1, below, below + 1);
      }
    }
  }
  return {positions: new Float32Array(normals), normals: new Float32Array(normals), indices: new Uint32Array(indices)};
}

// A square of flat tiles at z = 0 that face +z, each with one of these normals (3 n numbers, n a square number) in all its corners.
export function quads(given) {
  const side = Math.round(Math.sqrt(given.length / 3)), positions = [], normals = [], indices = [];
  for (let i = 0; i < side * side; i++) {
    const [x, y] = [i % side, Math.floor(i / side)];
    for (const [u, v] of [[0, 0], [1, 0], [1, 1], [0, 1]]) {
      positions.push(2 * (x + u) / side - 1, 2 * (y + v) / side - 1, 0);
      normals.push(...given.slice(3 * i, 3 * i + 3));
    }
    indices.push(4 * i, 4 * i + 1, 4 * i + 2, 4 * i, 4 * i + 2, 4 * i + 3);
  }
  return {positions: new Float32Array(positions), normals: new Float32Array(normals), indices: new Uint32Array(indices)};
}
