// SPDX-License-Identifier: Apache-2.0
// Goals to train the hand on, and how they are scored. Rules, no drawing. docs/decisions/page_training.md
import type { Answer, Mesh, Shape } from './protocol';
import { norm, pointOf, sub, type Vec3 } from './vec';

export const TRAIN_S = 15; // contact that keeping below a force takes
const LEAST_SHARE = 0.2; // of the limit: a finger that hardly touches trains nothing
const FAR = 0.03; // m; as far from the right place as that finds nothing
const GAP_S = 0.05; // a longer silence is no contact
const COST = 0.5; // of the points, for a search that was above the limit all the time

/** Contact under a force: how long, how much of it above a limit. */
export class Contact {
  seconds = 0; // with at least LEAST_SHARE of the limit
  above = 0; // of them, s
  strongest = 0; // N
  private lastUs = NaN;

  constructor(readonly limit: number) {} // N

  add(answers: readonly Answer[]): void {
    for (const { tUs, force } of answers) {
      const step = (tUs - this.lastUs) / 1e6;
      this.lastUs = tUs;
      this.strongest = Math.max(this.strongest, force);
      if (!(step > 0 && step <= GAP_S) || force < LEAST_SHARE * this.limit) continue;
      this.seconds += step;
      if (force > this.limit) this.above += step;
    }
  }

  /** Of the contact, 0 to 1; 0 without any. */
  get shareAbove(): number {
    return this.seconds > 0 ? this.above / this.seconds : 0;
  }

  /** Points of 100 for keeping below the limit: the share of the time that was. */
  get points(): number {
    return this.seconds > 0 ? Math.round(100 * (1 - this.shareAbove)) : 0;
  }
}

/** What to do before a place can be named; undefined: a press counted. */
export function adviceOf(contact: Contact): string | undefined {
  if (contact.seconds > 0) return undefined;
  return contact.strongest > 0 ? `Press harder: with more than ${(LEAST_SHARE * contact.limit).toFixed(1)} N.` : 'Press on the organ first.';
}

/** What is to be found: the region with the fewest nodes of those that end inside the organ. */
export function noduleOf(mesh: Mesh): Shape | undefined {
  const closed = mesh.regions.filter((region) => region.triangles.length > 0);
  return closed.reduce<Shape | undefined>((least, region) => (least && least.nodes <= region.nodes ? least : region), undefined);
}

/** The middle of a shape's box, m: of a nodule that reaches the organ's surface too, where its own surface is open. */
function middleOf({ positions }: Shape): Vec3 {
  const middle = (axis: number): number => {
    let [low, high] = [Infinity, -Infinity];
    for (let i = axis; i < positions.length; i += 3) [low, high] = [Math.min(low, positions[i]), Math.max(high, positions[i])];
    return (low + high) / 2;
  };
  return [middle(0), middle(1), middle(2)];
}

/** The right place: that which a tool may touch and is nearest to the nodule's middle, m. */
export function placeOver(mesh: Mesh, nodule: Shape): Vec3 {
  const middle = middleOf(nodule);
  let [best, least]: [Vec3, number] = [middle, Infinity];
  for (let n = 0; n < mesh.nodes; ++n) {
    if (!mesh.accessible[n]) continue;
    const point = pointOf(mesh.positions, n);
    const distance = norm(sub(point, middle));
    if (distance < least) [best, least] = [point, distance];
  }
  return best;
}

export interface Found {
  readonly off: number; // m from the right place
  readonly points: number; // of 100
}

/**
 * How well a place on the organ says where the nodule is. All points at the right place, none FAR away from it; up to COST of
 * them go for contact above the limit.
 */
export function scoreOf(mesh: Mesh, nodule: Shape, spot: Vec3, contact: Contact): Found {
  const off = norm(sub(spot, placeOver(mesh, nodule)));
  const found = Math.max(0, 1 - off / FAR);
  return { off, points: Math.round(100 * found * (1 - COST * contact.shareAbove)) };
}
