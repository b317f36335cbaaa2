// SPDX-License-Identifier: Apache-2.0
import { element } from './page';

const LEAST_MS = 2000; // between two texts: a screen reader speaks about five words a second

/** Time, which a test may play. */
export interface Clock {
  nowMs(): number;
  after(ms: number, act: () => void): number;
  cancel(timer: number): void;
}

const OF_THE_PAGE: Clock = {
  nowMs: () => performance.now(),
  after: (ms, act) => window.setTimeout(act, ms),
  cancel: (timer) => clearTimeout(timer),
};

/** Says things to screen readers, one at a time: of those that come faster the newest. Numbers that count on are no news. */
export class Announcer {
  private waiting: string | undefined;
  private saidMs = -Infinity;
  private timer = 0;
  private told = new Map<string, string>();

  constructor(
    private readonly region: Pick<HTMLElement, 'textContent'> = element('said', HTMLParagraphElement),
    private readonly clock: Clock = OF_THE_PAGE,
  ) {}

  /** @param topic  what it is of: a text that differs from the topic's last in its numbers only is not said */
  news(topic: string, text: string): void {
    const gist = text.replace(/\d+(\.\d+)?/g, '#');
    if (this.told.get(topic) === gist) return;
    this.told.set(topic, gist);
    this.say(text);
  }

  say(text: string): void {
    this.waiting = text;
    this.clock.cancel(this.timer);
    this.timer = this.clock.after(Math.max(0, this.saidMs + LEAST_MS - this.clock.nowMs()), () => this.speak());
  }

  private speak(): void {
    this.saidMs = this.clock.nowMs();
    this.region.textContent = this.waiting ?? '';
  }
}
