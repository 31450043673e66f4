// Babylon.js: the sphericalPolynomial of a black cube around a white PBRMaterial, a lat-long image as skybox, and what
// CubeMapToSphericalPolynomialTools makes of it.
import {script} from '../loading.mjs';

export async function open(canvas, size, rightHanded = false) {
  await script('/node_modules/babylonjs/babylon.js');
  const {BABYLON} = window;
  const engine = new BABYLON.Engine(canvas, false);
  const scene = new BABYLON.Scene(engine); // left-handed if nobody asks for anything else
  scene.useRightHandedSystem = rightHanded;
  scene.imageProcessingConfiguration.applyByPostProcess = true; // materials give linear radiance
  scene.clearColor = new BABYLON.Color4(0, 0, 0, 1);
  const camera = new BABYLON.TargetCamera('camera', BABYLON.Vector3.Zero(), scene);
  Object.assign(camera, {minZ: 0.1, maxZ: 100, orthoLeft: -1, orthoRight: 1, orthoBottom: -1, orthoTop: 1, fov: Math.PI / 2});
  const target = new BABYLON.RenderTargetTexture('target', size, scene, {type: BABYLON.Constants.TEXTURETYPE_FLOAT, generateMipMaps: false});
  target.activeCamera = camera;
  const cube = new BABYLON.RawCubeTexture(scene, Array.from({length: 6}, () => new Uint8Array([0, 0, 0, 255])), 1);
  const material = new BABYLON.PBRMaterial('white', scene);
  Object.assign(material, {albedoColor: BABYLON.Color3.White(), metallic: 0, roughness: 1, metallicF0Factor: 0, backFaceCulling: false});
  let mesh = null, sky = null;
  return {
    scene,
    async light(typed) {
      scene.environmentTexture = cube;
      await typed({BABYLON, scene});
    },
    around: (line) => `const texture = scene.environmentTexture; ${line}`,
    shape(given) {
      mesh?.dispose();
      mesh = new BABYLON.Mesh('body', scene);
      Object.assign(new BABYLON.VertexData(), given).applyToMesh(mesh);
      mesh.material = material;
    },
    async look(view) {
      const forward = new BABYLON.Vector3(...view.forward);
      const shown = view.inside ? sky : mesh;
      camera.mode = view.inside ? BABYLON.Camera.PERSPECTIVE_CAMERA : BABYLON.Camera.ORTHOGRAPHIC_CAMERA;
      camera.position = forward.scale(view.inside ? 0 : -5);
      camera.upVector = new BABYLON.Vector3(...view.up);
      camera.setTarget(forward.scale(10));
      target.renderList = [shown];
      await shown.material.forceCompilationAsync(shown);
      while (!target.isReadyForRendering()) await new Promise((done) => setTimeout(done, 10));
      target.render();
      return await target.readPixels();
    },
    usual: () => material.metallicF0Factor = 1,
    async surround(url) {
      this.panorama = await new Promise((done, failed) => {
        const texture = new BABYLON.HDRCubeTexture(url, scene, size, false, true, false, false, () => done(texture), (_, error) => failed(error));
      });
      sky = scene.createDefaultSkybox(this.panorama, true, 50, 0, false);
    },
    async project() {
      const own = BABYLON.SphericalHarmonics.FromPolynomial(this.panorama.sphericalPolynomial);
      return ['l00', 'l1_1', 'l10', 'l11', 'l2_2', 'l2_1', 'l20', 'l21', 'l22'].map((name) => own[name].asArray());
    },
  };
}
