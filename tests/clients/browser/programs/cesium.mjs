// Cesium: sphericalHarmonicCoefficients of a model's ImageBasedLighting. Vectors here are of the frame in which Cesium reads them:
// x is the model's local x, y its up, z its minus y; a glTF file's x is that frame's -z, its y the same, its z that frame's x.
import {floatCanvas} from '../float_canvas.mjs';
import {gltf, script} from '../loading.mjs';

const local = ([x, y, z]) => [x, -z, y];
const inFile = (vectors) => vectors.map((_, i) => [-vectors[i + 2], vectors[i], vectors[i - 2]][i % 3]);

export async function open(canvas, size) {
  const pixels = floatCanvas(canvas, size);
  window.CESIUM_BASE_URL = '/node_modules/cesium/Build/Cesium/';
  await script(`${window.CESIUM_BASE_URL}Cesium.js`);
  const {Cesium} = window;
  const scene = new Cesium.Scene({canvas, contextOptions: {webgl: {antialias: false}}, msaaSamples: 1});
  Object.assign(scene, {backgroundColor: Cesium.Color.BLACK, highDynamicRange: false});
  scene.fog.enabled = false;
  scene.postProcessStages.fxaa.enabled = false;
  const vector = (numbers) => new Cesium.Cartesian3(...numbers);
  scene.camera.frustum = Object.assign(new Cesium.OrthographicOffCenterFrustum(), {left: -1, right: 1, bottom: -1, top: 1, near: 0.1, far: 10});
  let lit = null, geometry = null, model = null;
  const frame = async () => {
    scene.initializeFrame();
    scene.render();
    await new Promise((done) => setTimeout(done, 0));
  };
  return {
    light(typed) {
      lit = typed;
      model = null;
    },
    around: (line) => `${line}; model.environmentMapManager.enabled = false`,
    shape(given) {
      geometry = given;
      model = null;
    },
    async look(view) {
      if (!model) {
        const {positions, normals, indices} = geometry;
        const file = await gltf({positions: inFile(positions), normals: inFile(normals), indices});
        scene.primitives.removeAll();
        model = scene.primitives.add(await Cesium.Model.fromGltfAsync({
          url: URL.createObjectURL(new Blob([file], {type: 'model/gltf+json'})),
          lightColor: Cesium.Cartesian3.ZERO,
          backFaceCulling: false,
        }));
        await lit({Cesium, model});
        while (!model.ready) await frame();
        for (let i = 0; i < 5; i++) await frame();
      }
      const [forward, up] = [vector(local(view.forward)), vector(local(view.up))];
      scene.camera.position = Cesium.Cartesian3.multiplyByScalar(forward, -5, new Cesium.Cartesian3());
      Object.assign(scene.camera, {direction: forward, up, right: Cesium.Cartesian3.cross(forward, up, new Cesium.Cartesian3())});
      await frame();
      await frame();
      return linear(pixels());
    },
  };
}

// The radiance of pixels that went through the curve of a canvas without HDR: minus 0.04 from 0.08 to 0.76, then the power 1/2.2
// [czm_pbrNeutralTonemapping, czm_inverseGamma].
function linear(pixels) {
  const found = pixels.map((value, i) => (i % 4 === 3 ? value : value ** 2.2 + 0.04));
  for (let i = 0; i < found.length; i++) {
    if (i % 4 < 3 && pixels[i] > 0 && (found[i] < 0.08 || found[i] > 0.76)) throw new Error(`radiance ${found[i]}: the curve is straight from 0.08 to 0.76`);
  }
  return found;
}
