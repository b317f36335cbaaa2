// SPDX-License-Identifier: Apache-2.0
import { flagWords } from './flags';
import { element, setText } from './page';
import { STATE_FREE, STATE_SLIDE, type Tool } from './protocol';
import type { Stage } from './stage';
import type { ToolMesh } from './tool_mesh';
import { norm } from './vec';

/** The tool whose numbers are shown: this page's own, else one that touches, else the first. */
export function toolToShow(tools: readonly Tool[]): Tool | undefined {
  return tools.find((tool) => tool.mine) ?? tools.find((tool) => tool.state !== STATE_FREE) ?? tools[0];
}

/** Force and penetration as large numbers, the contact in a word, and the force beside its arrow. */
export class Readout {
  private readonly force = element('force', HTMLOutputElement);
  private readonly penetration = element('penetration', HTMLOutputElement);
  private readonly contact = element('contact', HTMLParagraphElement);
  private readonly who = element('who', HTMLParagraphElement);
  private readonly label = element('arrow-label', HTMLOutputElement);
  private size = { w: 0, h: 0 }; // of the label, when it was seen last

  write(tool: Tool | undefined): void {
    setText(this.force, (tool ? norm(tool.force) : 0).toFixed(2));
    setText(this.penetration, (1000 * (tool?.penetration ?? 0)).toFixed(1));
    setText(this.contact, !tool ? 'no tool' : ['in the air', 'sticks', 'slides'][Math.min(tool.state, STATE_SLIDE)]);
    const news = tool ? flagWords(tool.flags)[0]?.words : undefined;
    setText(this.who, tool ? `${tool.mine ? 'your tool' : 'tool'} ${tool.id}${news ? ` · ${news}` : ''}` : 'nobody presses');
  }

  arrow(tool: Tool | undefined, mesh: ToolMesh | undefined, stage: Stage): void {
    const at = tool && mesh && norm(tool.force) >= 0.05 ? stage.onScreen(mesh.arrowTip) : undefined;
    // Asked for before anything is written, of the last words: the browser has laid these out already.
    const { clientWidth: width, clientHeight: height } = this.label.parentElement!;
    if (!this.label.hidden) this.measure();
    this.label.hidden = !at;
    if (!at || !tool || !mesh) return;
    setText(this.label, `${norm(tool.force).toFixed(2)} N`);
    if (this.size.w === 0) this.measure();
    const { w, h } = this.size;
    // Beyond the arrow's tip, on the side it points to, within the picture.
    const from = stage.onScreen(mesh.centre) ?? at;
    const within = (v: number, size: number, room: number): number => Math.min(room - size - 4, Math.max(4, v));
    const x = within(at.x >= from.x ? at.x + 8 : at.x - w - 8, w, width);
    const y = within(at.y - h / 2 + (at.y >= from.y ? 10 : -10), h, height);
    this.label.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
  }

  private measure(): void {
    this.size = { w: this.label.offsetWidth, h: this.label.offsetHeight };
  }
}
