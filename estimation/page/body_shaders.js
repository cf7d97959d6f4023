// The programs of the graphics card: one for the depths that the sun sees, one for the picture.
export const bodyShaders = {
  depthVertex: `#version 300 es
    in vec3 position;
    uniform mat4 sunClip;
    uniform vec4 place;  // the body's middle, and the factor of its lengths
    void main() { gl_Position = sunClip * vec4((position - place.xyz) * place.w, 1.0); }`,

  depthFragment: `#version 300 es
    void main() {}`,

  vertex: `#version 300 es
    in vec3 position, normal, color;
    in float value;
    uniform mat4 clip, sunClip;
    uniform vec4 place;
    uniform vec3 sun;
    out vec3 at, n, paint, inSun;
    out float shown;
    void main() {
      at = (position - place.xyz) * place.w;
      n = normal / max(length(normal), 1e-30);
      paint = color;
      shown = value;
      // Ground at a grazing sun would shadow itself; it is looked up a little above.
      float grazing = 1.0 - clamp(dot(n, sun), 0.0, 1.0);
      inSun = (sunClip * vec4(at + n * (0.003 + 0.010 * grazing), 1.0)).xyz * 0.5 + 0.5;
      gl_Position = clip * vec4(at, 1.0);
    }`,

  // The law "rock" of the programs: .35 of Lommel and Seeliger's, .65 of Lambert's. The dim light from everywhere is
  // brightest from behind the viewer. Colours that stand for values are shaded a little, and have no shadows.
  fragment: `#version 300 es
    precision highp float;
    precision highp sampler2DShadow;
    in vec3 at, n, paint, inSun;
    in float shown;
    uniform vec3 sun, eye;
    uniform float fill, texel;
    uniform bool valued, painted, labelled, plain;
    uniform sampler2DShadow depths;
    uniform sampler2D scale;
    out vec4 pixel;

    vec3 linear(vec3 c) { return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c)); }
    vec3 encoded(vec3 c) { return mix(c * 12.92, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c)); }

    float lit() {
      float sum = 0.0;
      for (int i = -1; i <= 1; ++i)
        for (int j = -1; j <= 1; ++j) sum += texture(depths, inSun + vec3(vec2(i, j) * texel, 0.0));
      return sum / 9.0;
    }

    void main() {
      vec3 normal = normalize(gl_FrontFacing ? n : -n), view = normalize(eye - at);
      float sunward = dot(normal, sun), viewward = max(dot(normal, view), 0.02);
      if (valued || plain) {
        vec3 c = plain ? paint : texture(scale, vec2(labelled ? (shown + 0.5) / 16.0 : (0.5 + 255.0 * clamp(shown, 0.0, 1.0)) / 256.0, 0.5)).rgb;
        pixel = vec4(c * (0.82 + 0.18 * sunward) * mix(0.6, 1.0, smoothstep(0.0, 0.25, viewward)), 1.0);
        return;
      }
      vec3 albedo = painted ? linear(paint) : vec3(0.44, 0.425, 0.40);
      float mu = max(sunward, 0.0);
      float law = mu * (0.65 + 0.70 / (mu + viewward));
      float light = mu > 0.0 ? law * lit() : 0.0;
      light = light * 1.45 + fill * (0.35 + 0.65 * viewward);
      vec3 c = albedo * light;
      c = c / (1.0 + 0.25 * c * c);
      pixel = vec4(encoded(clamp(c, 0.0, 1.0)), 1.0);
    }`,
};
