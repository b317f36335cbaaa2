// SPDX-License-Identifier: Apache-2.0
// What everything in the picture is drawn with: one short shader. Each further one has to be compiled, which takes longer than to draw
// the picture where there is no graphics hardware.
import { Color, DoubleSide, GLSL3, RawShaderMaterial, Vector3, type ColorRepresentation } from 'three';

/** How something shines (J. F. Blinn, 1977): its exponent, and the colour that it reflects straight on. */
export interface Gloss {
  readonly shininess: number;
  readonly specular: number;
}

/** The light, for all that is drawn: from above and below, W/m^2 of each colour up to a factor. */
export const LIGHT = { sky: { value: new Color() }, ground: { value: new Color() } };

const KEY = { direction: [-0.7, 0.9, 0.8], colour: 0xfff6ea, strength: 2.1 } as const; // directions to the lights, as the camera sees them
const RIM = { direction: [0.9, 0.2, -0.5], colour: 0xcfe0ff, strength: 0.7 } as const;

const VERTEX = `
uniform mat4 modelViewMatrix, projectionMatrix;
uniform mat3 normalMatrix;
in vec3 position, normal;
in vec4 color;
out vec3 n, toEye;
out vec4 tint;
void main() {
  vec4 seen = modelViewMatrix * vec4(position, 1.0);
  n = normalMatrix * normal;
  toEye = -seen.xyz;
  tint = color;
  gl_Position = projectionMatrix * seen;
}`;

// Lambert's reflection of all light, and Blinn's of both directional lights, with the exponent's normalization (T. Akenine-Moeller et al.,
// Real-Time Rendering, 2008, section 7.6) and C. Schlick's term of Fresnel (1994). Colours are linear until the end.
const FRAGMENT = `
precision highp float;
uniform mat4 viewMatrix;
uniform vec3 colour, specular, sky, ground, keyDirection, keyLight, rimDirection, rimLight;
uniform float opacity, shininess, flatness;
in vec3 n, toEye;
in vec4 tint;
out vec4 pixel;
vec3 reflected(vec3 normal, vec3 eye, vec3 direction, vec3 base) {
  vec3 middle = normalize(direction + eye);
  float aslant = 1.0 - max(dot(eye, middle), 0.0), twice = aslant * aslant;
  vec3 fresnel = specular + (1.0 - specular) * twice * twice * aslant;
  float shine = 0.25 * (0.5 * shininess + 1.0) * pow(max(dot(normal, middle), 0.0), shininess);
  return max(dot(normal, direction), 0.0) * (base + shine * fresnel);
}
void main() {
  vec3 base = colour * tint.rgb;
  vec3 shown = base;
  if (flatness < 0.5) {
    vec3 normal = normalize(gl_FrontFacing ? n : -n), eye = normalize(toEye);
    float high = 0.5 + 0.5 * dot(normal, viewMatrix[2].xyz);
    shown = (mix(ground, sky, high) * base + keyLight * reflected(normal, eye, keyDirection, base) + rimLight * reflected(normal, eye, rimDirection, base)) / 3.14159265;
  }
  shown = clamp(shown, 0.0, 1.0);
  pixel = vec4(mix(12.92 * shown, 1.055 * pow(shown, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, shown)), opacity * tint.a);
}`;

const lightOf = ({ direction, colour, strength }: typeof KEY | typeof RIM) => ({
  direction: { value: new Vector3(...direction).normalize() },
  light: { value: new Color(colour).multiplyScalar(strength) },
});
const [key, rim] = [lightOf(KEY), lightOf(RIM)];

/** Colour, times that of the nodes where they have one: three numbers, or four with an opacity. */
export class Lit extends RawShaderMaterial {
  readonly colour = new Color(0xffffff);

  /** @param gloss  none: it has its colour in any light */
  constructor(gloss?: Gloss, colour: ColorRepresentation = 0xffffff) {
    super({ glslVersion: GLSL3, vertexShader: VERTEX, fragmentShader: FRAGMENT });
    this.colour.set(colour);
    this.uniforms = {
      ...LIGHT,
      keyDirection: key.direction,
      keyLight: key.light,
      rimDirection: rim.direction,
      rimLight: rim.light,
      colour: { value: this.colour },
      specular: { value: new Color() },
      shininess: { value: 1 },
      opacity: { value: 1 },
      flatness: { value: gloss ? 0 : 1 },
    };
    if (gloss) this.gloss = gloss;
  }

  set gloss({ shininess, specular }: Gloss) {
    this.uniforms['shininess']!.value = shininess;
    (this.uniforms['specular']!.value as Color).setHex(specular);
  }

  /** @param opacity  below 1: one sees through it, and it hides nothing */
  seeThrough(opacity: number): this {
    this.uniforms['opacity']!.value = opacity;
    return this.translucent(opacity < 1);
  }

  /** For colours of nodes that have an opacity. */
  translucent(on = true): this {
    this.transparent = on;
    this.depthWrite = !on; // else its triangles hide each other in any order
    return this;
  }

  /** Also from within. */
  fromBothSides(): this {
    this.side = DoubleSide;
    return this;
  }
}
