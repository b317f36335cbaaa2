// SPDX-License-Identifier: Apache-2.0
import type { Answer } from './protocol';
import { UNKNOWN, type Settings } from './settings';
import type { Vec3 } from './vec';

export const SPAN_US = 10e6;

export interface Sample {
  readonly tUs: number; // viewer's clock
  readonly toolId: number;
  readonly force: number; // N
  readonly penetration: number; // m
  readonly flags: number;
  readonly forceVector: Vec3; // on the tool, N
  readonly tip: Vec3; // its centre, m
  readonly settings: Settings; // in force
}

/** Force and penetration of one tool over the last ten seconds, in order of time. */
export class Strip {
  private samples: Sample[] = [];

  /** Drops a sample that is not newer than the last: a reconnect brings no answer twice. */
  add(answer: Answer, settings: Settings): void {
    const last = this.samples.at(-1);
    if (last && answer.tUs <= last.tUs) return;
    const { tUs, toolId, force, penetration, flags, forceVector, tip } = answer;
    this.samples.push({ tUs, toolId, force, penetration, flags, forceVector, tip, settings });
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

  add(answers: readonly Answer[], settings: Settings = UNKNOWN): void {
    for (const answer of answers) this.of(answer.toolId).add(answer, settings);
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
