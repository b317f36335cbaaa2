// SPDX-License-Identifier: Apache-2.0
import { element, setText } from './page';

const SHOWN_MS = 5000;

/** A few words over the organ, gone after some seconds. */
export class Notice {
  private readonly box = element('notice', HTMLParagraphElement);
  private timer = 0;

  show(text: string): void {
    setText(this.box, text);
    this.box.hidden = false;
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => (this.box.hidden = true), SHOWN_MS);
  }
}
