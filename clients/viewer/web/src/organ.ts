// SPDX-License-Identifier: Apache-2.0
import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Mesh, Sphere, Vector3, type Scene } from 'three';
import { ABSENT, CLAMPED, DISPLACEMENT, NO_ANSWER, NOT_FELT, niceCeiling, rgbOf, STIFFNESS, TISSUE } from './colours';
import type { FeltMap } from './felt';
import { Lit } from './lit';
import type { Surface } from './surface';
import { mottled } from './tissue';

export type Colouring = 'displacement' | 'stiffness' | 'plain';

const LEAST_TOP = 0.002; // m
const AT_REST = 1e-4; // m
const SHOWS_INSIDE = 0.4; // opacity
const CLAMPED_RGB = rgbOf(CLAMPED);
const NO_ANSWER_RGB = rgbOf(NO_ANSWER);
const WET = { shininess: 110, specular: 0x6a625c };
const MATT = { shininess: 36, specular: 0x2b2b2b }; // a highlight hides the colour of a scale

/** The drawn organ: lit, shaded, coloured. */
export class OrganMesh {
  private readonly geometry = new BufferGeometry();
  private readonly colours: Float32Array;
  private readonly material = new Lit(WET);
  private readonly mesh: Mesh;
  private spots: Float32Array | undefined; // of the tissue, 0 to 1; none until dress()
  private coloured: Colouring | 'absent' | undefined; // what the colours are, where they do not change
  private top = LEAST_TOP; // m, end of the displacement scale

  constructor(
    private readonly surface: Surface,
    private readonly felt: FeltMap,
    private readonly scene: Scene,
  ) {
    const dynamic = (array: Float32Array): BufferAttribute => new BufferAttribute(array, 3).setUsage(DynamicDrawUsage);
    this.colours = new Float32Array(3 * surface.mesh.nodes);
    this.geometry.setAttribute('position', dynamic(surface.now));
    this.geometry.setAttribute('normal', dynamic(surface.normals));
    this.geometry.setAttribute('color', dynamic(this.colours));
    this.geometry.setIndex(new BufferAttribute(surface.mesh.triangles, 1));
    this.geometry.boundingSphere = new Sphere(new Vector3(...surface.centre), surface.size); // generous: it deforms
    this.mesh = new Mesh(this.geometry, this.material);
    scene.add(this.mesh);
  }

  remove(): void {
    this.scene.remove(this.mesh);
    this.geometry.dispose();
    this.material.dispose();
  }

  /** Whether one sees through it to what is inside. */
  setTranslucent(on: boolean): void {
    this.material.seeThrough(on ? SHOWS_INSIDE : 1);
  }

  moved(): void {
    this.geometry.attributes['position'].needsUpdate = true;
    this.geometry.attributes['normal'].needsUpdate = true;
  }

  /** End of the displacement scale, m: grows with the displacement, and is reset at rest. */
  get displacementTop(): number {
    return this.top;
  }

  fitScale(): void {
    const { largest } = this.surface;
    this.top = largest < AT_REST ? LEAST_TOP : Math.max(this.top, niceCeiling(largest));
  }

  /** Gives the tissue its spots: not before the first picture, which is not to wait for them. */
  dress(): void {
    this.spots ??= mottled(this.surface);
    this.coloured = undefined;
  }

  /** @param how  absent: nobody answers for the organ */
  colour(how: Colouring | 'absent'): void {
    const still = how === 'plain' || how === 'absent';
    if (still && how === this.coloured) return;
    this.coloured = still ? how : undefined;
    this.material.gloss = how === 'plain' ? WET : MATT;
    if (how === 'absent') for (let n = 0; n < this.surface.mesh.nodes; ++n) this.colours.set(ABSENT, 3 * n);
    else this.paint(how);
    this.geometry.attributes['color'].needsUpdate = true;
  }

  private paint(how: Colouring): void {
    const { displaced, mesh } = this.surface;
    for (let n = 0; n < mesh.nodes; ++n) {
      if (mesh.clamped[n]) this.colours.set(CLAMPED_RGB, 3 * n);
      else if (!mesh.accessible[n]) this.colours.set(NO_ANSWER_RGB, 3 * n);
      else if (how === 'displacement') DISPLACEMENT.write(displaced[n] / this.top, this.colours, 3 * n);
      else if (how === 'plain') TISSUE.write(this.spots?.[n] ?? 0.5, this.colours, 3 * n);
      else if (this.felt.weight[n] < 0.02) this.colours.set(NOT_FELT, 3 * n);
      else STIFFNESS.write(this.felt.share(n), this.colours, 3 * n);
    }
  }
}
