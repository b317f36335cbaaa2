// SPDX-License-Identifier: Apache-2.0
import {
  ConeGeometry,
  CylinderGeometry,
  Group,
  Mesh,
  SphereGeometry,
  Vector3,
  type Scene,
} from 'three';
import { Lit } from './lit';
import { STATE_FREE, type Tool } from './protocol';
import { gapTo, restingCentre } from './resting';
import type { Surface } from './surface';
import { add, norm, scale, unit, type Vec3 } from './vec';

const UP = new Vector3(0, 1, 0); // of three's cylinders

/** One tool: its tip, a handle, and the force on it as an arrow. */
export class ToolMesh {
  centre: Vec3 = [0, 0, 0];
  arrowTip: Vec3 = [0, 0, 0];
  gap = NaN; // from the drawn tip's surface to the drawn organ's, m; below 0: inside
  private readonly group = new Group();
  private readonly arrow = new Group();
  private readonly handle = new Group();
  private readonly steel = new Lit({ shininess: 90, specular: 0x777777 });
  private readonly ink = new Lit();
  private readonly head: Mesh;
  private readonly shaft: Mesh;

  constructor(
    private readonly scene: Scene,
    private readonly radius: number, // of the tip, m
  ) {
    const handle = new Mesh(new CylinderGeometry(0.62 * radius, 0.34 * radius, 14 * radius, 20), this.steel);
    handle.position.y = 7.6 * radius;
    this.handle.add(handle);
    this.shaft = new Mesh(new CylinderGeometry(0.2 * radius, 0.2 * radius, 1, 16), this.ink);
    this.head = new Mesh(new ConeGeometry(0.55 * radius, 1.3 * radius, 20), this.ink);
    this.arrow.add(this.shaft, this.head);
    this.group.add(new Mesh(new SphereGeometry(radius, 32, 20), this.steel), this.handle, this.arrow);
    scene.add(this.group);
  }

  setColours(steel: string, ink: string): void {
    this.steel.colour.set(steel);
    this.ink.colour.set(ink);
  }

  /** @param lengthPerNewton  of the arrow, m/N */
  show(tool: Tool, surface: Surface, lengthPerNewton: number): void {
    const touching = tool.state !== STATE_FREE;
    const n = touching ? surface.normalNear(tool.proxy) : surface.normalNear(tool.tip);
    this.centre = touching ? restingCentre(surface, tool.proxy, n, this.radius) : tool.tip;
    this.group.position.set(...this.centre);
    // The handle leans towards the zenith, out of the arrow's way.
    this.handle.quaternion.setFromUnitVectors(UP, new Vector3(...unit(add(n, [0.35, -0.2, 0.7]))));
    const reach = 4 * this.radius + surface.size / Math.sqrt(surface.mesh.nodes);
    this.gap = gapTo(surface, this.centre, reach) - this.radius;
    this.showForce(tool.force, lengthPerNewton);
  }

  remove(): void {
    this.scene.remove(this.group);
    this.group.traverse((part) => part instanceof Mesh && part.geometry.dispose());
    this.steel.dispose();
    this.ink.dispose();
  }

  private showForce(force: Vec3, lengthPerNewton: number): void {
    const length = norm(force) * lengthPerNewton;
    this.arrow.visible = length > 0.2 * this.radius;
    const along = unit(force);
    this.arrow.quaternion.setFromUnitVectors(UP, new Vector3(...along));
    const from = 1.05 * this.radius;
    this.shaft.scale.y = Math.max(1e-6, length);
    this.shaft.position.y = from + length / 2;
    this.head.position.y = from + length + 0.6 * this.radius;
    this.arrowTip = add(this.centre, scale(along, from + length + 1.3 * this.radius));
  }
}
