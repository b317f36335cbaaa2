// SPDX-License-Identifier: Apache-2.0
import { niceCeiling } from './colours';
import { FeltMap } from './felt';
import { InsideMesh } from './inside';
import { OrganMesh, type Colouring } from './organ';
import type { Frame, Mesh, Tool } from './protocol';
import type { Stage } from './stage';
import { Surface } from './surface';
import { themeColour } from './theme';
import { ToolMesh } from './tool_mesh';
import { norm } from './vec';

const REACH = 2; // of the felt map, in tip radii

/** One drawn organ and the tools on it. */
export class OrganView {
  readonly surface: Surface;
  readonly felt: FeltMap;
  tools: readonly Tool[] = [];
  colouring: Colouring = 'plain';
  private absent = false;
  private readonly organ: OrganMesh;
  private readonly inside: InsideMesh;
  private readonly toolMeshes = new Map<number, ToolMesh>();
  private forceTop = 1; // N, of the arrows' scale
  private stiffness = NaN; // live E over the model's
  private undrawn: Frame | undefined; // its field waits for the next picture
  private dirty = true;
  private moved = true;

  constructor(
    mesh: Mesh,
    private readonly stage: Stage,
    private tipRadius: number, // m
  ) {
    this.surface = new Surface(mesh);
    this.felt = new FeltMap(this.surface, REACH * tipRadius);
    this.organ = new OrganMesh(this.surface, this.felt, stage.scene);
    this.inside = new InsideMesh(mesh.regions, stage.scene);
    stage.welcome(this.surface);
  }

  get displacementTop(): number {
    return this.organ.displacementTop;
  }

  remove(): void {
    this.organ.remove();
    this.inside.remove();
    this.removeTools();
  }

  showInside(on: boolean): void {
    this.organ.setTranslucent(on);
    this.inside.visible = on;
    this.dirty = true;
  }

  /** Another server, the same organ. With another tip the felt map starts empty: each tip feels another stiffness. */
  setTip(radius: number): void {
    if (radius === this.tipRadius) return;
    this.tipRadius = radius;
    this.removeTools();
    this.felt.setReach(REACH * radius);
    this.dirty = true;
  }

  /** What was felt is not true of another E. @param factor  live E over the model's; NaN: unknown */
  setStiffness(factor: number): void {
    if (Number.isNaN(factor) || factor === this.stiffness) return;
    if (!Number.isNaN(this.stiffness)) this.felt.clear();
    this.stiffness = factor;
    this.dirty = true;
  }

  private removeTools(): void {
    for (const tool of this.toolMeshes.values()) tool.remove();
    this.toolMeshes.clear();
  }

  /** @param on  nobody answers for the organ: it is grey */
  setAbsent(on: boolean): void {
    if (on === this.absent) return;
    this.absent = on;
    this.dirty = true;
  }

  /** The tissue gets its spots. */
  dress(): void {
    this.organ.dress();
    this.dirty = true;
  }

  setColouring(colouring: Colouring): void {
    this.colouring = colouring;
    this.dirty = true;
  }

  restyle(): void {
    for (const mesh of this.toolMeshes.values()) mesh.setColours(themeColour('--steel'), themeColour('--force'));
    this.dirty = true;
  }

  frame(frame: Frame): void {
    if (frame.nodes > 0) this.undrawn = frame;
    if (this.felt.learn(frame) && this.colouring === 'stiffness') this.dirty = true;
    if (!sameTools(this.tools, frame.tools)) this.dirty = true;
    this.tools = frame.tools;
  }

  /** No server describes the organ now: shows it at rest, without tools. */
  calm(): void {
    this.undrawn = undefined;
    this.surface.calm();
    this.tools = [];
    this.dirty = this.moved = true;
  }

  /** Updates what is drawn. @return whether anything changed since the last call */
  update(): boolean {
    if (this.undrawn && this.surface.show(this.undrawn)) this.moved = this.dirty = true;
    this.undrawn = undefined;
    if (!this.dirty) return false;
    if (this.moved) this.organ.moved();
    this.organ.fitScale();
    this.organ.colour(this.absent ? 'absent' : this.colouring);
    this.updateTools();
    this.dirty = this.moved = false;
    return true;
  }

  /** The drawn tool, if it is there. */
  toolMesh(id: number): ToolMesh | undefined {
    return this.toolMeshes.get(id);
  }

  private updateTools(): void {
    const strongest = this.tools.reduce((top, tool) => Math.max(top, norm(tool.force)), 0);
    this.forceTop = Math.max(this.forceTop, niceCeiling(strongest));
    for (const [id, mesh] of this.toolMeshes) {
      if (this.tools.some((tool) => tool.id === id)) continue;
      mesh.remove();
      this.toolMeshes.delete(id);
    }
    for (const tool of this.tools) this.meshOf(tool.id).show(tool, this.surface, (0.22 * this.surface.size) / this.forceTop);
  }

  private meshOf(id: number): ToolMesh {
    let mesh = this.toolMeshes.get(id);
    if (!mesh) {
      mesh = new ToolMesh(this.stage.scene, this.tipRadius);
      mesh.setColours(themeColour('--steel'), themeColour('--force'));
      this.toolMeshes.set(id, mesh);
    }
    return mesh;
  }
}

function sameTools(a: readonly Tool[], b: readonly Tool[]): boolean {
  const near = (p: readonly number[], q: readonly number[], least: number): boolean => p.every((x, i) => Math.abs(x - q[i]) < least);
  return (
    a.length === b.length &&
    a.every((tool, i) => {
      const other = b[i];
      return tool.id === other.id && tool.state === other.state && near(tool.proxy, other.proxy, 2e-5) &&
        near(tool.tip, other.tip, 2e-5) && near(tool.force, other.force, 2e-3);
    })
  );
}
