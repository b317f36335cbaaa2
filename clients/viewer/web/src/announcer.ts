// SPDX-License-Identifier: Apache-2.0
import { element } from './page';

const LEAST_MS = 2000; // between two texts: a screen reader speaks about five words a second

/** Says things to screen readers, one at a time: of those that come faster the newest. Numbers that count on are no news. */
export class Announcer {
  private readonly region: HTMLElement;
  private waiting: string | undefined;
  private saidMs = -Infinity;
  private timer = 0;
  private told = new Map<string, string>();

  constructor(region: HTMLElement = element('said', HTMLParagraphElement)) {
    this.region = region;
  }

  /** @param topic  what it is of: a text that differs from the topic's last in its numbers only is not said */
  news(topic: string, text: string): void {
    const gist = text.replace(/\d+(\.\d+)?/g, '#');
    if (this.told.get(topic) === gist) return;
    this.told.set(topic, gist);
    this.say(text);
  }

  say(text: string): void {
    this.waiting = text;
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.speak(), Math.max(0, this.saidMs + LEAST_MS - performance.now()));
  }

  private speak(): void {
    this.saidMs = performance.now();
    this.region.textContent = this.waiting ?? '';
  }
}
