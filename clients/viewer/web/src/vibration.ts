// SPDX-License-Identifier: Apache-2.0
import { recall, remember } from './memory';
import { element } from './page';
import { STATE_FREE, type Tool } from './protocol';

const KEY = 'palpate-vibration';
const PULSE_MS = 15;

/** A pulse when this page's tool comes to the organ, where the machine can: a cue, not the force. The panel has its switch. */
export class Vibration {
  private touching = false;
  private readonly box = element('vibrate', HTMLInputElement);

  constructor() {
    if (!('vibrate' in navigator)) return;
    element('vibrate-row', HTMLLabelElement).hidden = false;
    this.box.checked = recall(KEY) !== 'off';
    this.box.addEventListener('change', () => remember(KEY, this.box.checked ? 'on' : 'off'));
  }

  /** Call with each frame's tools. */
  feel(tools: readonly Tool[]): void {
    const was = this.touching;
    this.touching = tools.some(({ mine, state }) => mine && state !== STATE_FREE);
    if (this.touching && !was && this.box.checked) navigator.vibrate(PULSE_MS);
  }
}
