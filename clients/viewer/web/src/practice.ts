// SPDX-License-Identifier: Apache-2.0
import type { Announcer } from './announcer';
import { inWords, LastPress, type Pressed } from './last_press';
import type { Frame, Mesh } from './protocol';
import { TrainingCard } from './training_card';

/** What comes of this page's presses: words for screen readers, the last one's figures, goals and their scores. */
export class Practice {
  private readonly press: LastPress;
  private readonly card: TrainingCard;

  /** @param blind  told whether the inside may not be looked at */
  constructor(announcer: Announcer, blind: (on: boolean) => void) {
    this.press = new LastPress(
      () => announcer.say('Touching'),
      (pressed) => announcer.say(`Let go: ${inWords(pressed)}`),
    );
    this.card = new TrainingCard(() => this.press.newest, blind, (text) => announcer.say(text));
  }

  get last(): Pressed | undefined {
    return this.press.newest;
  }

  organ(mesh: Mesh): void {
    this.press.forget();
    this.card.organ(mesh);
  }

  frame(frame: Frame): void {
    this.card.feel(this.press.frame(frame));
  }

  /** Nobody answers any more. */
  end(): void {
    this.press.end();
    this.card.end();
  }
}
