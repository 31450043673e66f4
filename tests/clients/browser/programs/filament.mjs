// Filament: irradianceSh of an IndirectLight on the white material that its glTF reader makes.
import {floatCanvas} from '../float_canvas.mjs';
import {gltf, script} from '../loading.mjs';

export async function open(canvas, size) {
  const pixels = floatCanvas(canvas, size);
  await script('/node_modules/gl-matrix/gl-matrix-min.js');
  Object.assign(window, window.glMatrix); // Filament looks for mat4, vec3 and so on there
  await script('/node_modules/filament/filament.js');
  await new Promise((ready) => window.Filament.init([], ready));
  const {Filament} = window; // another one than before
  const engine = Filament.Engine.create(canvas), scene = engine.createScene(), view = engine.createView();
  const chain = engine.createSwapChain(), renderer = engine.createRenderer();
  const camera = engine.createCamera(Filament.EntityManager.get().create());
  camera.setExposureDirect(1);
  renderer.setClearOptions({clearColor: [0, 0, 0, 1], clear: true});
  Object.entries({Camera: camera, Scene: scene, Viewport: [0, 0, size, size]}).forEach(([name, value]) => view[`set${name}`](value));
  view.setPostProcessingEnabled(false);
  const loader = engine.createAssetLoader();
  const triangle = {positions: new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]), normals: new Float32Array([0, 0, 1, 0, 0, 1, 0, 0, 1]), indices: new Uint32Array([0, 1, 2])};
  const asset = loader.createAsset(new TextEncoder().encode(await gltf(triangle)));
  await new Promise((done) => asset.loadResources(done, () => {}, null, null));
  const manager = engine.getRenderableManager();
  const material = manager.getMaterialInstanceAt(manager.getInstance(asset.getRenderableEntities()[0]), 0);
  let body = null;
  return {
    light: (typed) => typed({Filament, engine, scene, lux: 1}),
    around: (line) => `const light = ${line}; light.setIntensity(lux); scene.setIndirectLight(light)`,
    shape({positions, normals, indices}) {
      const count = positions.length / 3;
      const types = Filament['VertexBuffer$AttributeType'], names = Filament.VertexAttribute;
      const tangents = new Float32Array(4 * count), white = new Float32Array(4 * count).fill(1);
      for (let i = 0; i < count; i++) tangents.set(quaternion(normals.slice(3 * i, 3 * i + 3)), 4 * i);
      const vertices = Filament.VertexBuffer.Builder().vertexCount(count).bufferCount(3)
        .attribute(names.POSITION, 0, types.FLOAT3, 0, 0)
        .attribute(names.TANGENTS, 1, types.FLOAT4, 0, 0)
        .attribute(names.COLOR, 2, types.FLOAT4, 0, 0)
        .attribute(names.UV0, 2, types.FLOAT2, 0, 16)
        .attribute(names.UV1, 2, types.FLOAT2, 0, 16).build(engine);
      [positions, tangents, white].forEach((array, i) => vertices.setBufferAt(engine, i, array));
      const triangles = Filament.IndexBuffer.Builder().indexCount(indices.length).bufferType(Filament['IndexBuffer$IndexType'].UINT).build(engine);
      triangles.setBuffer(engine, indices);
      if (body) scene.remove(body);
      body = Filament.EntityManager.get().create();
      Filament.RenderableManager.Builder(1).boundingBox({center: [0, 0, 0], halfExtent: [2, 2, 2]}).culling(false)
        .castShadows(false).receiveShadows(false).material(0, material)
        .geometry(0, Filament['RenderableManager$PrimitiveType'].TRIANGLES, vertices, triangles).build(engine, body);
      scene.addEntity(body);
    },
    async look(where) {
      camera.setProjection(Filament['Camera$Projection'].ORTHO, -1, 1, -1, 1, 0.1, 10);
      camera.lookAt(where.forward.map((value) => -5 * value), [0, 0, 0], where.up);
      for (let drawn = 0; drawn < 2;) { // it leaves frames out while it is busy; the first of all only prepares its programs
        if (renderer.beginFrame(chain)) {
          renderer.renderView(view);
          renderer.endFrame();
          drawn += 1;
        }
        engine.execute();
        await new Promise((done) => setTimeout(done, 0));
      }
      return pixels();
    },
  };
}

// The turn, as x y z w with w > 0, that takes +z to a unit vector.
function quaternion([x, y, z]) {
  if (z < -0.999999) return [1, 0, 0, 1e-6];
  const w = Math.sqrt((1 + z) / 2);
  return [-y / (2 * w), x / (2 * w), 0, w];
}
