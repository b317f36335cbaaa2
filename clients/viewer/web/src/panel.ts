// SPDX-License-Identifier: Apache-2.0
import type { Said } from './connection';
import type { Figures } from './figures';
import { flagWords } from './flags';
import { lateWords } from './late_words';
import type { Line } from './line';
import { brief, element, numberIn, setText } from './page';
import type { Stage } from './stage';

const WRITE_MS = 250;
const SLOW_WRITE_MS = 1000; // where words take as long to lay out and draw as a picture, beside the organ itself
type Level = '' | 'warn' | 'bad';
/** Rows that say nothing on a page that has its organ itself. */
const OF_A_VIEWER = new Set(['DDS to decoded', 'Round trip to viewer', 'Woke late', 'Late ticks', 'Real time', 'Pages at the viewer']);
const asRecord = (value: unknown): Record<string, unknown> => (typeof value === 'object' && value !== null ? (value as Record<string, unknown>) : {});

/** Rates, latencies and health, in numbers and words; times as p50 / p99, the server's of its run, its last minute and its last second. */
export class Panel {
  private readonly list = element('health-list', HTMLDListElement);
  private readonly flags = element('flags', HTMLUListElement);
  private readonly event = element('event', HTMLParagraphElement);
  private readonly rows = new Map<string, HTMLElement>();
  private written: HTMLElement | undefined; // the row before, behind which a new one goes
  private shownFlags = '';
  private nextMs = 0;
  status: Said | undefined; // the newest
  kept: string | undefined; // empty when the page works without a network, or why not; undefined: not known yet
  private isAlone = false;

  constructor(
    private readonly figures: Figures,
    private readonly line: Line,
    private readonly stage: Stage | undefined,
  ) {}

  heard(status: Said | undefined): void {
    this.status = status;
  }

  /** This page has no viewer. */
  alone(): void {
    this.isAlone = true;
    this.list.replaceChildren();
    this.rows.clear();
  }

  /** Call in each turn. @param flags  of all tools in the last seconds, or-ed */
  write(nowMs: number, flags: number): void {
    if (nowMs < this.nextMs) return;
    this.nextMs = nowMs + (this.isAlone && this.stage?.software ? SLOW_WRITE_MS : WRITE_MS);
    this.written = undefined;
    this.page(nowMs);
    this.server(this.status ?? { type: 'status' });
    this.words(flags);
    setText(this.event, String(this.status?.['message'] ?? ''));
  }

  private page(nowMs: number): void {
    const { drawn, received, decodedMs, shownMs } = this.figures;
    const rate = drawn.rate(nowMs);
    this.row('Pictures drawn', rate > 0 ? `${brief(rate, 0)} / s` : 'at rest');
    this.row('Frames received', `${brief(received.rate(nowMs), 0)} / s of ${brief(received.mean() / 1000)} kB`);
    this.row('DDS to decoded', pair(decodedMs, 'ms'), decodedMs.percentile(0.5) > 50 ? 'warn' : '');
    this.row(this.isAlone ? 'Field to picture' : 'DDS to picture', pair(shownMs, 'ms'));
    this.row('Round trip to viewer', `${brief(this.line.tripMs)} ms`);
    if (this.stage) this.row('Drawn by', shortName(this.stage.drawnBy));
  }

  private server(status: Said): void {
    const viewer = asRecord(status['viewer']);
    const overruns = numberIn(status, 'overruns');
    const ticks = numberIn(status, 'ticks');
    this.row(this.isAlone ? 'Ticks' : 'Server', Number.isFinite(ticks) ? `${brief(numberIn(status, 'rate_hz'), 0)} Hz, ${String(status['device'] ?? '–')}` : '–');
    if (this.isAlone) this.row('Fields evaluated', `${brief(numberIn(status, 'fields_hz'), 0)} / s`);
    this.times('Tick', 'tick', status);
    this.times('Woke late', 'wakeup', status);
    this.row('Ticks missed', Number.isFinite(overruns) ? `${overruns} of ${ticks}` : '–', overruns > 0.01 * ticks ? 'bad' : '');
    this.row('Late ticks', lateWords(asRecord(status['late_ticks'])));
    const granted = status['realtime'];
    this.row('Real time', granted === undefined ? '–' : granted ? 'granted' : 'not granted', granted === false ? 'warn' : '');
    this.row('Force limit', `${brief(numberIn(status, 'force_limit'))} N`);
    this.row('Pages at the viewer', brief(numberIn(viewer, 'pages'), 0));
    if (this.kept !== undefined) this.row('Without a network', this.kept || 'works');
  }

  // Median and 99 % over the run, and where the server says them beside it over its last minute and second.
  private times(name: string, key: string, status: Said): void {
    const over = (span: string): string => {
      const said = asRecord(status[`${key}${span}_us`]);
      return `${brief(numberIn(said, 'p50'), 0)} / ${brief(numberIn(said, 'p99'), 0)} µs`;
    };
    this.row(name, over(''));
    if (status[`${key}_second_us`] === undefined) return;
    this.row(`${name}, last minute`, over('_minute'));
    this.row(`${name}, last second`, over('_second'));
  }

  private row(name: string, value: string, level: Level = ''): void {
    if (this.isAlone && OF_A_VIEWER.has(name)) return;
    let cell = this.rows.get(name);
    if (!cell) {
      const term = document.createElement('dt');
      term.textContent = name;
      cell = document.createElement('dd');
      if (this.written) this.written.after(term, cell);
      else this.list.prepend(term, cell);
      this.rows.set(name, cell);
    }
    this.written = cell;
    setText(cell, value);
    if (cell.dataset['level'] !== level) cell.dataset['level'] = level;
  }

  private words(flags: number): void {
    const words = flagWords(flags);
    const key = words.map((w) => w.words).join();
    if (key === this.shownFlags) return;
    this.shownFlags = key;
    this.flags.replaceChildren(
      ...words.map(({ words: text, severe }) => {
        const item = document.createElement('li');
        item.textContent = text;
        if (severe) item.dataset['severe'] = '';
        return item;
      }),
    );
  }
}

const pair = (recent: { percentile(share: number): number }, unit: string): string =>
  `${brief(recent.percentile(0.5))} / ${brief(recent.percentile(0.99))} ${unit}`;

/** "ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (LLVM 16)), ..)" -> "SwiftShader (software)". */
export function shortName(renderer: string): string {
  if (/swiftshader|llvmpipe|softpipe/i.test(renderer)) return `${/swiftshader/i.test(renderer) ? 'SwiftShader' : 'llvmpipe'} (software)`;
  return (/ANGLE \([^,]*, ([^,(]*)/.exec(renderer)?.[1] ?? renderer).trim().slice(0, 40);
}
