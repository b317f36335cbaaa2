// SPDX-License-Identifier: Apache-2.0
import { element, setText } from './page';
import { DEEPEST } from './press';
import type { Tool } from './protocol';

const LEAST_DEPTH = 5e-4; // m; less deep than that, a touch may be about to slide elsewhere

/** How deep a press along the normal is where the model ends there, m: d_max of the touched point. NaN where none is touched. */
export function endOfModel(tool: Tool): number {
  return tool.domainRadius > 0 && tool.penetration >= LEAST_DEPTH ? tool.domainRadius : NaN;
}

/** The depth of a press, which slider, wheel and keys set. Shows where the model ends, once a touch has told it. */
export class DepthSlider {
  private wanted = 0; // m
  private end = NaN; // m, at the newest touch
  private readonly slider = element('depth', HTMLInputElement);
  private readonly text = element('depth-text', HTMLOutputElement);
  private readonly track = element('depth-track', HTMLDivElement);
  private readonly note = element('depth-end', HTMLParagraphElement);

  constructor() {
    this.slider.max = String(1000 * DEEPEST);
    this.slider.addEventListener('input', () => this.set(Number(this.slider.value) / 1000));
    this.set(Number(this.slider.value) / 1000);
  }

  /** m */
  get depth(): number {
    return this.wanted;
  }

  set(metres: number): void {
    this.wanted = Math.min(DEEPEST, Math.max(0, metres));
    this.slider.value = String(1000 * this.wanted);
    this.write();
  }

  /** Call with this page's tool. */
  feel(tool: Tool | undefined): void {
    const end = tool ? endOfModel(tool) : NaN;
    if (Number.isNaN(end) || Math.abs(end - this.end) < 1e-4) return;
    this.end = end;
    this.write();
  }

  /** Another organ: its end is not known yet. */
  forget(): void {
    this.end = NaN;
    this.write();
  }

  private write(): void {
    const { wanted, end } = this;
    const known = end < DEEPEST;
    const beyond = known && wanted > end;
    const mm = (metres: number): string => (1000 * metres).toFixed(1);
    setText(this.text, `${mm(wanted)} mm${beyond ? ', beyond the model' : ''}`);
    this.text.toggleAttribute('data-beyond', beyond);
    this.track.style.setProperty('--end', String(known ? end / DEEPEST : 1));
    const where = known ? `the model ends at about ${mm(end)} mm here` : '';
    setText(this.note, known ? `Striped: ${where}` : end >= DEEPEST ? 'The model reaches all of it here' : 'A press shows where the model ends');
    this.slider.setAttribute('aria-valuetext', `${mm(wanted)} millimetres${where ? `; ${where.replace('mm', 'millimetres')}` : ''}`);
  }
}
