// A canvas whose pixels are float32: for programs that can only draw to the canvas itself. Call before they make their context.
export function floatCanvas(canvas, size) {
  const context = WebGL2RenderingContext.prototype;
  let gl, target;
  const {getContext} = canvas, {bindFramebuffer, drawBuffers, readBuffer, invalidateFramebuffer, texImage2D} = context;
  const make = () => {
    target = gl.createFramebuffer();
    ['EXT_color_buffer_float', 'OES_texture_float_linear'].forEach((name) => gl.getExtension(name));
    const texture = gl.createTexture(), depth = gl.createRenderbuffer();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, size, size);
    gl.bindTexture(gl.TEXTURE_2D, null);
    gl.bindRenderbuffer(gl.RENDERBUFFER, depth);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH24_STENCIL8, size, size);
    gl.bindRenderbuffer(gl.RENDERBUFFER, null);
    bindFramebuffer.call(gl, gl.FRAMEBUFFER, target);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_STENCIL_ATTACHMENT, gl.RENDERBUFFER, depth);
  };
  canvas.getContext = function (kind, ...rest) {
    const first = !gl, made = getContext.call(canvas, kind, ...rest);
    if (kind === 'webgl2' && first) {
      gl = made;
      make();
    }
    return made;
  };
  const inside = (buffer) => (buffer === gl.BACK ? gl.COLOR_ATTACHMENT0 : buffer);
  const attachments = {0x1800: 0x8ce0, 0x1801: 0x8d00, 0x1802: 0x8d20}; // COLOR, DEPTH, STENCIL as those of a framebuffer
  context.bindFramebuffer = function (where, framebuffer) { bindFramebuffer.call(this, where, framebuffer ?? target); };
  context.drawBuffers = function (buffers) { drawBuffers.call(this, buffers.map(inside)); };
  context.readBuffer = function (buffer) { readBuffer.call(this, inside(buffer)); };
  context.invalidateFramebuffer = function (where, list) { invalidateFramebuffer.call(this, where, list.map((at) => attachments[at] ?? at)); };
  context.texImage2D = function (...given) { // what is made empty is to be drawn into, as a stage on the way to the canvas
    if (given.length === 9 && !given[8] && given[7] === gl.UNSIGNED_BYTE && given[3] === size) [given[2], given[7]] = [gl.RGBA32F, gl.FLOAT];
    texImage2D.apply(this, given);
  };
  return () => {
    const pixels = new Float32Array(size * size * 4);
    bindFramebuffer.call(gl, gl.READ_FRAMEBUFFER, target);
    readBuffer.call(gl, gl.COLOR_ATTACHMENT0);
    gl.readPixels(0, 0, size, size, gl.RGBA, gl.FLOAT, pixels);
    return pixels;
  };
}
