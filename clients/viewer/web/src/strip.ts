// SPDX-License-Identifier: Apache-2.0
import type { Answer } from './protocol';

export const SPAN_US = 10e6;

export interface Sample {
  readonly tUs: number; // viewer's clock
  readonly toolId: number;
  readonly force: number; // N
  readonly penetration: number; // m
  readonly flags: number;
}

/** Force and penetration of one tool over the last ten seconds, in order of time. */
export class Strip {
  private samples: Sample[] = [];

  /** Drops a sample that is not newer than the last: a reconnect brings no answer twice. */
  add(answer: Answer): void {
    const last = this.samples.at(-1);
    if (last && answer.tUs <= last.tUs) return;
    const { tUs, toolId, force, penetration, flags } = answer;
    this.samples.push({ tUs, toolId, force, penetration, flags });
    if (this.samples.length > 16 && this.samples[8].tUs < tUs - SPAN_US) {
      const first = this.samples.findIndex((s) => s.tUs >= tUs - SPAN_US);
      this.samples.splice(0, first);
    }
  }

  clear(): void {
    this.samples = [];
  }

  get length(): number {
    return this.samples.length;
  }

  /** The samples from `fromUs` on. */
  since(fromUs: number): readonly Sample[] {
    const first = this.samples.findIndex((s) => s.tUs >= fromUs);
    return first < 0 ? [] : this.samples.slice(first);
  }

  last(): Sample | undefined {
    return this.samples.at(-1);
  }
}

/** The strips of all tools. */
export class Strips {
  private readonly byTool = new Map<number, Strip>();

  add(answers: readonly Answer[]): void {
    for (const answer of answers) this.of(answer.toolId).add(answer);
  }

  of(toolId: number): Strip {
    let strip = this.byTool.get(toolId);
    if (!strip) this.byTool.set(toolId, (strip = new Strip()));
    return strip;
  }

  clear(): void {
    this.byTool.clear();
  }

  /** The ten seconds up to the newest sample of any tool. */
  all(): Sample[] {
    const strips = [...this.byTool.values()];
    const newest = Math.max(...strips.map((strip) => strip.last()?.tUs ?? -Infinity));
    return strips.flatMap((strip) => [...strip.since(newest - SPAN_US)]);
  }
}

/** Comma-separated values (RFC 4180, without the carriage returns), SI units in the header; t from the first sample. */
export function csvOf(samples: readonly Sample[]): string {
  const sorted = [...samples].sort((a, b) => a.tUs - b.tUs || a.toolId - b.toolId);
  const start = sorted[0]?.tUs ?? 0;
  const lines = sorted.map(
    (s) => `${((s.tUs - start) / 1e6).toFixed(6)},${s.toolId},${s.force.toPrecision(6)},${s.penetration.toPrecision(6)},${s.flags}`,
  );
  return ['t_s,tool_id,force_N,penetration_m,flags', ...lines, ''].join('\n');
}
