// SPDX-License-Identifier: Apache-2.0
import { DISPLACEMENT, STIFFNESS } from './colours';
import type { Caption } from './picture';
import type { OrganView } from './organ_view';
import type { Colouring } from './organ';
import { brief, element, setText } from './page';
import type { Stage } from './stage';

/** The scale of the colours, and a ruler. */
export class Legend {
  private readonly ramp = element('ramp', HTMLDivElement);
  private readonly bar = element('ramp-bar', HTMLElement);
  private readonly low = element('ramp-low', HTMLSpanElement);
  private readonly high = element('ramp-high', HTMLSpanElement);
  private readonly rule = element('rule-bar', HTMLElement);
  private readonly ruleText = element('rule-text', HTMLSpanElement);
  private written: Colouring | undefined;

  /** @param swatches  what the legend names beside the scale */
  constructor(
    choose: (colouring: Colouring) => void,
    private readonly swatches: () => Caption['swatches'],
  ) {
    for (const input of document.querySelectorAll<HTMLInputElement>('input[name=colouring]'))
      input.addEventListener('change', () => input.checked && choose(input.value as Colouring));
  }

  write(view: OrganView, stage: Stage): void {
    this.writeRule(stage);
    const { colouring, felt } = view;
    if (this.written !== colouring) {
      this.ramp.hidden = colouring === 'plain';
      this.bar.style.background = (colouring === 'stiffness' ? STIFFNESS : DISPLACEMENT).gradient();
      this.written = colouring;
    }
    if (colouring === 'displacement') {
      setText(this.low, '0');
      setText(this.high, `${brief(1000 * view.displacementTop, 0)} mm`);
    } else if (Number.isFinite(felt.low)) {
      setText(this.low, (felt.low / 1000).toFixed(2));
      setText(this.high, `${(felt.high / 1000).toFixed(2)} N/mm`);
    } else {
      setText(this.low, 'press to');
      setText(this.high, 'feel');
    }
  }

  /** The same for a picture. */
  drawn(): Pick<Caption, 'scale' | 'swatches' | 'rule'> {
    const map = this.written === 'stiffness' ? STIFFNESS : DISPLACEMENT;
    const scale = { stops: map.stops(), low: this.low.textContent ?? '', high: this.high.textContent ?? '' };
    return {
      scale: this.written === 'plain' || this.written === undefined ? undefined : scale,
      swatches: this.swatches(),
      rule: { pixels: parseFloat(this.rule.style.width) || 0, words: this.ruleText.textContent ?? '' },
    };
  }

  private writeRule(stage: Stage): void {
    const pixels = stage.pixelsPerMetre;
    const length = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1].findLast((m) => m * pixels < 130) ?? 0.001;
    this.rule.style.width = `${(length * pixels).toFixed(1)}px`;
    setText(this.ruleText, length >= 0.01 ? `${Math.round(100 * length)} cm` : `${Math.round(1000 * length)} mm`);
  }
}
