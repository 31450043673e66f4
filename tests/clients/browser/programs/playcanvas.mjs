// PlayCanvas: ambientSH of a white StandardMaterial, a lat-long image as skybox, and what shFromCubemap makes of it, which went with
// version 2.
import * as pc from 'playcanvas';

export async function open(canvas, size) {
  const device = await pc.createGraphicsDevice(canvas, {deviceTypes: ['webgl2']});
  const options = new pc.AppOptions();
  Object.assign(options, {
    graphicsDevice: device,
    componentSystems: [pc.RenderComponentSystem, pc.CameraComponentSystem],
    resourceHandlers: [pc.TextureHandler],
  });
  const app = new pc.AppBase(canvas);
  app.init(options);
  app.autoRender = false;
  app.start();
  app.scene.ambientLight = new pc.Color(0, 0, 0);
  const texture = new pc.Texture(device, {width: size, height: size, format: pc.PIXELFORMAT_RGBA32F, mipmaps: false});
  const target = new pc.RenderTarget({colorBuffer: texture, depth: true});
  const material = new pc.StandardMaterial();
  Object.assign(material, {diffuse: new pc.Color(1, 1, 1), specular: new pc.Color(0, 0, 0), useSkybox: false, cull: pc.CULLFACE_NONE});
  const camera = new pc.Entity('camera'), body = new pc.Entity('body');
  camera.addComponent('camera', {renderTarget: target, toneMapping: pc.TONEMAP_NONE, gammaCorrection: pc.GAMMA_NONE, nearClip: 0.1, farClip: 10});
  app.root.addChild(camera);
  app.root.addChild(body);
  const panorama = async (url) => {
    const asset = new pc.Asset('light', 'texture', {url}, {type: pc.TEXTURETYPE_RGBE, mipmaps: false});
    app.assets.add(asset);
    await new Promise((done, failed) => {
      asset.ready(done);
      asset.on('error', failed);
      app.assets.load(asset);
    });
    return asset.resource;
  };
  return {
    light: (typed) => typed({material}),
    around: (line) => `${line}; material.update()`,
    shape({positions, normals, indices}) {
      const mesh = new pc.Mesh(device);
      mesh.setPositions(positions);
      mesh.setNormals(normals);
      mesh.setIndices(indices);
      mesh.update();
      if (body.render) body.removeComponent('render');
      body.addComponent('render', {meshInstances: [new pc.MeshInstance(mesh, material)]});
    },
    async look(view) {
      const forward = new pc.Vec3(...view.forward);
      body.enabled = !view.inside;
      Object.assign(camera.camera, view.inside ? {projection: pc.PROJECTION_PERSPECTIVE, fov: 90} : {projection: pc.PROJECTION_ORTHOGRAPHIC, orthoHeight: 1});
      camera.camera.aspectRatioMode = pc.ASPECT_MANUAL;
      camera.camera.aspectRatio = 1;
      camera.setPosition(forward.clone().mulScalar(view.inside ? 0 : -5));
      camera.lookAt(forward.clone().mulScalar(10), new pc.Vec3(...view.up));
      app.render();
      return await texture.read(0, 0, size, size, {renderTarget: target, immediate: true});
    },
    usual() {
      Object.assign(material, {useMetalness: true, metalness: 0, gloss: 0, specular: new pc.Color(1, 1, 1)});
      material.update();
    },
    async surround(url) {
      app.scene.skybox = pc.EnvLighting.generateSkyboxCubemap(await panorama(url), size);
    },
    async project(url) {
      const cube = new pc.Texture(device, {width: size, height: size, cubemap: true, format: pc.PIXELFORMAT_RGBA32F, mipmaps: false});
      pc.reprojectTexture(await panorama(url), cube, {numSamples: 1});
      const faces = await Promise.all([0, 1, 2, 3, 4, 5].map((face) => cube.read(0, 0, size, size, {face, immediate: true})));
      const old = await import('playcanvas-1');
      // It takes 8 bits a channel, of the power 1/2.2: half the light fits.
      const encoded = faces.map((face) => Uint8Array.from(face, (value) => Math.round(255 * (value / 2) ** (1 / 2.2))));
      const texture = {format: old.PIXELFORMAT_RGBA8, type: old.TEXTURETYPE_DEFAULT, width: size, _levels: [encoded]};
      return Array.from(old.shFromCubemap(null, texture, false), (value) => 2 * value);
    },
  };
}
