// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Announcer, type Clock } from '../src/announcer';

/** A clock that stands until it is told to go on, and a region that remembers its texts and when they came. */
class Stage implements Clock {
  readonly said: [number, string | null][] = [];
  private ms = 0;
  private timers = new Map<number, { due: number; act: () => void }>();
  private count = 0;
  readonly announcer: Announcer;

  constructor() {
    const said = this.said;
    const now = (): number => this.ms;
    this.announcer = new Announcer({ set textContent(text: string | null) { said.push([now(), text]); } }, this);
  }

  nowMs(): number {
    return this.ms;
  }
  after(ms: number, act: () => void): number {
    this.timers.set(++this.count, { due: this.ms + ms, act });
    return this.count;
  }
  cancel(timer: number): void {
    this.timers.delete(timer);
  }

  passes(ms: number): void {
    for (const end = this.ms + ms; this.ms <= end; ++this.ms)
      for (const [timer, { due, act }] of [...this.timers])
        if (due <= this.ms) {
          this.timers.delete(timer);
          act();
        }
    --this.ms;
  }
}

test('a text is said at once, the next two seconds later, and of those that come between only the newest', () => {
  const stage = new Stage();
  stage.announcer.say('Touching');
  stage.passes(500);
  assert.deepEqual(stage.said, [[0, 'Touching']]);
  stage.announcer.say('Let go: at most 1.00 N');
  stage.passes(500);
  stage.announcer.say('Touching');
  stage.passes(500);
  stage.announcer.say('Let go: at most 2.00 N');
  stage.passes(5000);
  assert.deepEqual(stage.said, [[0, 'Touching'], [2000, 'Let go: at most 2.00 N']]);
  stage.announcer.say('Touching');
  stage.passes(0);
  assert.deepEqual(stage.said.at(-1), [6500, 'Touching']);
});

test('a thousand texts a second are one every two seconds', () => {
  const stage = new Stage();
  for (let i = 0; i < 10_000; ++i) {
    stage.announcer.say(`text ${i}`);
    stage.passes(1);
  }
  assert.deepEqual(stage.said.map(([ms]) => ms), [0, 2000, 4000, 6000, 8000, 10_000]);
});

test('numbers that count on are no news, other words and other topics are', () => {
  const stage = new Stage();
  const texts = (): (string | null)[] => stage.said.map(([, text]) => text);
  const tell = (topic: string, text: string): void => {
    stage.announcer.news(topic, text);
    stage.passes(3000);
  };
  tell('state', 'Connected, 60 fields per second');
  tell('state', 'Connected, 59.5 fields per second');
  assert.deepEqual(texts(), ['Connected, 60 fields per second']);
  tell('server', 'Connected, 60 fields per second');
  tell('state', 'The server is gone');
  tell('state', 'Connected, 58 fields per second');
  assert.equal(texts().length, 4);
});
