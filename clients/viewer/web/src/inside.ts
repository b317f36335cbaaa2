// SPDX-License-Identifier: Apache-2.0
import { BufferAttribute, BufferGeometry, Group, Mesh, type Scene } from 'three';
import { REGIONS } from './colours';
import { Lit } from './lit';
import type { Shape } from './protocol';

/** Of each region; undefined: it ends nowhere inside the organ, and is not drawn. */
export function coloursOf(regions: readonly Shape[]): (string | undefined)[] {
  let drawn = 0;
  return regions.map((region) => (region.triangles.length > 0 ? REGIONS[drawn++ % REGIONS.length] : undefined));
}

/** Where the organ's regions end, at rest: the model knows displacements of the organ's surface only. */
export class InsideMesh {
  private readonly group = new Group();

  constructor(
    regions: readonly Shape[],
    private readonly scene: Scene,
  ) {
    coloursOf(regions).forEach((colour, index) => colour && this.group.add(drawn(regions[index], colour)));
    this.group.visible = false;
    scene.add(this.group);
  }

  set visible(on: boolean) {
    this.group.visible = on;
  }

  remove(): void {
    this.scene.remove(this.group);
    for (const mesh of this.group.children as Mesh<BufferGeometry, Lit>[]) {
      mesh.geometry.dispose();
      mesh.material.dispose();
    }
  }
}

function drawn(region: Shape, color: string): Mesh {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(region.positions, 3));
  geometry.setIndex(new BufferAttribute(region.triangles, 1));
  geometry.computeVertexNormals();
  // A region that reaches the organ's surface is open there, and seen from within.
  return new Mesh(geometry, new Lit({ shininess: 20, specular: 0x222222 }, color).fromBothSides());
}
