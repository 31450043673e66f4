// glTF with EXT_lights_image_based, as the loader of Babylon.js reads it: its light on the same white sphere as in babylon.mjs.
import {script} from '../loading.mjs';
import {open as openBabylon} from './babylon.mjs';

export async function open(canvas, size) {
  const {scene, shape, look, usual} = await openBabylon(canvas, size);
  await script('/node_modules/babylonjs-loaders/babylonjs.loaders.js');
  const {BABYLON} = window;
  const black = Object.assign(document.createElement('canvas'), {width: 2, height: 2});
  black.getContext('2d').fillRect(0, 0, 2, 2);
  const images = Array.from({length: 6}, () => ({uri: black.toDataURL('image/png')}));
  return {
    shape, look, usual,
    around: (line) => `
      gltf.extensionsUsed = ['EXT_lights_image_based'];
      gltf.extensions = {EXT_lights_image_based: {lights: [{intensity: 1, specularImages, specularImageSize}]}};
      gltf.scenes[0].extensions = {EXT_lights_image_based: {light: 0}};
      ${line}`,
    async light(typed) {
      const gltf = {asset: {version: '2.0'}, images, scene: 0, scenes: [{nodes: []}]};
      await typed({gltf, specularImages: [[0, 1, 2, 3, 4, 5]], specularImageSize: 2});
      await BABYLON.ImportMeshAsync(`data:${JSON.stringify(gltf)}`, scene, {pluginExtension: '.gltf'});
    },
  };
}
