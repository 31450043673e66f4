// three.js: a LightProbe on a white MeshLambertMaterial, a lat-long image as background, LightProbeGenerator.
import * as THREE from 'three';
import {HDRLoader} from 'three/addons/loaders/HDRLoader.js';
import {LightProbeGenerator} from 'three/addons/lights/LightProbeGenerator.js';

export async function open(canvas, size) {
  const renderer = new THREE.WebGLRenderer({canvas});
  const target = new THREE.WebGLRenderTarget(size, size, {type: THREE.FloatType});
  const scene = new THREE.Scene();
  const mesh = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshLambertMaterial({color: 0xffffff}));
  const outside = new THREE.OrthographicCamera(-1, 1, 1, -1, 0.1, 10), inside = new THREE.PerspectiveCamera(90, 1, 0.1, 10);
  const panorama = async (url) => {
    const loader = new HDRLoader().setDataType(THREE.FloatType);
    const texture = await loader.loadAsync(url);
    texture.mapping = THREE.EquirectangularReflectionMapping;
    return texture;
  };
  scene.add(mesh);
  return {
    async light(typed) {
      scene.remove(...scene.children.filter((child) => child.isLightProbe));
      await typed({THREE, scene});
    },
    around: (line) => `const probe = new THREE.LightProbe(); scene.add(probe); ${line}`,
    shape({positions, normals, indices}) {
      mesh.geometry = new THREE.BufferGeometry();
      mesh.geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
      mesh.geometry.setAttribute('normal', new THREE.BufferAttribute(normals, 3));
      mesh.geometry.setIndex(new THREE.BufferAttribute(indices, 1));
    },
    look(view) {
      const camera = view.inside ? inside : outside, forward = new THREE.Vector3(...view.forward);
      mesh.visible = !view.inside;
      camera.position.copy(forward).multiplyScalar(view.inside ? 0 : -5);
      camera.up.set(...view.up);
      camera.lookAt(forward.multiplyScalar(10));
      renderer.setRenderTarget(target);
      renderer.render(scene, camera);
      const pixels = new Float32Array(size * size * 4);
      renderer.readRenderTargetPixels(target, 0, 0, size, size, pixels);
      return pixels;
    },
    usual: () => mesh.material = new THREE.MeshStandardMaterial({color: 0xffffff, roughness: 1}),
    async surround(url) {
      scene.background = await panorama(url);
    },
    async project(url) {
      const cube = new THREE.WebGLCubeRenderTarget(size, {type: THREE.FloatType});
      cube.fromEquirectangularTexture(renderer, await panorama(url));
      return (await LightProbeGenerator.fromCubeRenderTarget(renderer, cube)).sh.toArray();
    },
  };
}
