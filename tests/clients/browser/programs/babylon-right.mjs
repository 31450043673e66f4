// Babylon.js with a right-handed scene.
import {open as openBabylon} from './babylon.mjs';

export const open = (canvas, size) => openBabylon(canvas, size, true);
