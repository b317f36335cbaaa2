// SPDX-License-Identifier: Apache-2.0
import { STATE_FREE, type Answer, type Frame } from './protocol';
import type { Vec3 } from './vec';

/** What one press came to. */
export interface Pressed {
  readonly force: number; // largest, N
  readonly depth: number; // largest penetration, m
  readonly spot: Vec3; // where it touched last, on the organ at rest, m
}

/** This page's press: what it came to, while it lasts and afterwards. */
export class LastPress {
  private now: Pressed | undefined;
  private touching = false;
  private toolId: number | undefined; // of the frame before
  newest: Pressed | undefined;

  /** @param began, ended  told of each contact of this page's tool with the organ */
  constructor(
    private readonly began: () => void,
    private readonly ended: (pressed: Pressed) => void,
  ) {}

  /** @return this page's answers in the frame */
  frame(frame: Frame): readonly Answer[] {
    const mine = frame.tools.find((tool) => tool.mine);
    const toolId = mine ? mine.id : this.toolId; // the last answers of a tool come in the frame that shows it free, or no more
    this.toolId = mine?.id;
    const answers = frame.answers.filter((answer) => answer.toolId === toolId);
    if (mine && mine.state !== STATE_FREE) {
      this.goOn(mine.anchor, answers);
    } else {
      if (this.now) this.goOn(this.now.spot, answers);
      this.end();
    }
    return answers;
  }

  /** The tool is gone. */
  end(): void {
    if (!this.touching) return;
    this.touching = false;
    if (this.now) this.ended((this.newest = this.now));
    this.now = undefined;
  }

  /** Another organ: what was felt of the one before is no press on it. */
  forget(): void {
    this.end();
    this.newest = undefined;
  }

  private goOn(spot: Vec3, answers: readonly Answer[]): void {
    if (!this.touching) this.began();
    this.touching = true;
    const most = (before: number | undefined, values: readonly number[]): number => values.reduce((top, v) => Math.max(top, v), before ?? 0);
    const force = most(this.now?.force, answers.map((a) => a.force));
    const depth = most(this.now?.depth, answers.map((a) => a.penetration));
    this.newest = this.now = { force, depth, spot };
  }
}

export const inWords = ({ force, depth }: Pressed): string => `at most ${force.toFixed(2)} N, ${(1000 * depth).toFixed(1)} mm deep`;
