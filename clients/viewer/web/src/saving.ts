// SPDX-License-Identifier: Apache-2.0
import { csvOf } from './csv';
import { inWords, type Pressed } from './last_press';
import type { Legend } from './legend';
import { download, element, timeStamp } from './page';
import { savePicture, type Caption } from './picture';
import type { Tool } from './protocol';
import type { Settings } from './settings';
import type { Stage } from './stage';
import type { Sample } from './strip';
import { norm } from './vec';

/** What is saved, as the page knows it when a button is pressed. */
export interface Shown {
  readonly organ: string; // its name
  readonly tool: Tool | undefined;
  readonly last: Pressed | undefined;
  readonly settings: Settings;
  readonly samples: readonly Sample[];
}

function forceLine({ tool, last }: Shown): string {
  const now = `Force ${norm(tool?.force ?? [0, 0, 0]).toFixed(2)} N, penetration ${(1000 * (tool?.penetration ?? 0)).toFixed(1)} mm`;
  return last ? `${now}; last press ${inWords(last)}` : now;
}

function settingsLine({ youngsModulus, friction, tipRadius }: Settings): string {
  const said = (value: number, words: string): string[] => (Number.isNaN(value) ? [] : [words]);
  return [
    ...said(youngsModulus, `E ${(youngsModulus / 1000).toFixed(1)} kPa`),
    ...said(friction, Number.isFinite(friction) ? `friction ${friction.toFixed(2)}` : 'never slides'),
    ...said(tipRadius, `tip of ${(1000 * tipRadius).toFixed(1)} mm`),
  ].join(', ');
}

/** "2026-11-25 18:40:07", local time. */
const dateLine = (now = new Date()): string => {
  const local = new Date(now.getTime() - 60_000 * now.getTimezoneOffset());
  return local.toISOString().slice(0, 19).replace('T', ' ');
};

/** The buttons that save a picture of the organ, and the curves. */
export class Saving {
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly stage: Stage,
    private readonly legend: Legend,
    private readonly shown: () => Shown,
    private readonly trouble: (text: string) => void,
  ) {
    element('csv', HTMLButtonElement).addEventListener('click', () => this.saveStrip());
    element('picture', HTMLButtonElement).addEventListener('click', () => this.savePicture());
  }

  private saveStrip(): void {
    download(`palpate-${timeStamp()}.csv`, new Blob([csvOf(this.shown().samples)], { type: 'text/csv' }));
  }

  private caption(): Caption {
    const shown = this.shown();
    const lines = [forceLine(shown), settingsLine(shown.settings), dateLine()].filter(Boolean);
    return { title: `palpate: ${shown.organ || 'an organ'}`, lines, ...this.legend.drawn() };
  }

  savePicture(): void {
    this.stage.draw(); // the canvas keeps its picture until this turn ends
    savePicture(this.canvas, this.caption(), this.trouble);
  }
}
