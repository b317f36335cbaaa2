// SPDX-License-Identifier: Apache-2.0
import { CLAMPED, NO_ANSWER } from './colours';
import type { Said } from './connection';
import { coloursOf } from './inside';
import { brief, element, numberIn, setText } from './page';
import type { Mesh } from './protocol';

interface Region {
  readonly name: string;
  readonly youngs: number; // E of the model, Pa
}

/** The legend's lines of what is clamped, what cannot be touched and what is inside; of an organ that has none of it, nothing. */
export class RegionList {
  private readonly box = element('parts', HTMLDivElement);
  private readonly texts: { region: Region; text: HTMLElement }[] = [];
  private readonly swatches: { colour: string; text: HTMLElement }[] = [];
  private box_: HTMLInputElement | undefined; // whether the inside is seen
  private blind = false;
  private announced: readonly Region[] = [];
  private factor = 1;
  private on = false;

  constructor(private readonly choose: (inside: boolean) => void) {}

  /** What is said of the regions just before a mesh, in its order. */
  announce(message: Said): void {
    const list = Array.isArray(message['regions']) ? (message['regions'] as Record<string, unknown>[]) : [];
    this.announced = list.map((region) => ({ name: String(region['name'] ?? ''), youngs: numberIn(region, 'youngs_modulus') }));
  }

  /** A new organ. @return whether its inside is to be seen */
  show(mesh: Mesh): boolean {
    this.texts.length = 0;
    this.box.replaceChildren();
    this.box_ = undefined;
    this.swatches.length = 0;
    if (mesh.clamped.some((clamped) => clamped !== 0)) this.line(CLAMPED, 'clamped');
    if (mesh.accessible.some((open, n) => !open && !mesh.clamped[n])) this.line(NO_ANSWER, 'cannot be touched');
    const colours = coloursOf(mesh.regions);
    if (!colours.some(Boolean)) return false;
    this.box.append(this.checkbox());
    colours.forEach((colour, index) => {
      const region = this.announced[index] ?? { name: '', youngs: NaN };
      this.texts.push({ region, text: this.line(colour, '') });
    });
    this.write();
    return this.on && !this.blind;
  }

  /** @param factor  live E over the model's, the same for all regions; NaN while it is unknown */
  scale(factor: number): void {
    this.factor = factor > 0 ? factor : 1;
    this.write();
  }

  /** While on, the inside is not seen. */
  hide(on: boolean): void {
    this.blind = on;
    if (this.box_) this.box_.disabled = on;
    this.choose(this.on && !on);
  }

  /** Colours and words, for a picture's legend. The inside counts while it is seen. */
  lines(): { colour: string; words: string }[] {
    const inside = new Set(this.on && !this.blind ? [] : this.texts.map(({ text }) => text));
    return this.swatches.filter(({ text }) => !inside.has(text)).map(({ colour, text }) => ({ colour, words: text.textContent ?? '' }));
  }

  private write(): void {
    for (const { region, text } of this.texts) setText(text, `${region.name} ${brief((this.factor * region.youngs) / 1000)} kPa`);
  }

  /** @param colour undefined: it is not drawn */
  private line(colour: string | undefined, words: string): HTMLElement {
    const line = document.createElement('p');
    const swatch = document.createElement('i');
    swatch.style.background = colour ?? '';
    swatch.hidden = !colour;
    const text = document.createElement('span');
    text.textContent = words;
    if (colour) this.swatches.push({ colour, text });
    line.append(swatch, text);
    this.box.append(line);
    return text;
  }

  private checkbox(): HTMLElement {
    const label = document.createElement('label');
    const input = document.createElement('input');
    input.type = 'checkbox';
    input.checked = this.on;
    input.disabled = this.blind;
    this.box_ = input;
    input.addEventListener('change', () => this.choose((this.on = input.checked)));
    const note = document.createElement('span');
    note.className = 'quiet';
    note.textContent = '(drawn at rest)';
    label.title = 'The model knows how the surface moves, not what is under it: the inside stays where it is when the organ is pressed.';
    label.append(input, 'Show inside ', note);
    return label;
  }
}
