// SPDX-License-Identifier: Apache-2.0
import type { Organ } from '../../../../core/wasm/organ.mjs';
import { certificateLine } from './certificate';
import { clockMs } from './clock';
import type { Said } from './connection';
import { later } from './press';
import type { Answer, Frame, Mesh } from './protocol';
import type { Vec3 } from './vec';

const TIP_RADIUS = 0.005; // m
const TICK_MS = 1;
const [LEAST_WAKE_MS, MOST_WAKE_MS] = [4, 8]; // between wake-ups, each of which runs the ticks since the last one
const MOST_TICKS = 25; // of one wake-up: a page that stood still does not catch up
const STATUS_MS = 1000;
const REST_TICKS = 300; // after the last tool, in which forces and fields fade
const [LEAST_HZ, MOST_HZ] = [1, 1000];
const USUAL_HZ = 60; // of fields, until the page asks for others
const TARGET_MS = 12; // between repetitions of a target
const HOLD_MS = 1000; // longest repetition of a target while a busy page sends no new one
const MOST_ANSWERS = 2000; // kept for a page that takes no frames

export interface Told {
  said(said: Said): void;
  mesh(mesh: Mesh): void;
  frame(frame: Frame): void;
}

const vector = (v: readonly number[]): Vec3 => [v[0]!, v[1]!, v[2]!];

/** Median and 99 % of the newest times, us. */
class Times {
  private readonly newest: number[] = [];

  add(us: number): void {
    this.newest.push(us);
    if (this.newest.length > 2000) this.newest.splice(0, 1000);
  }

  get summary(): { p50: number; p99: number } {
    const sorted = [...this.newest].sort((a, b) => a - b);
    const at = (q: number): number => sorted[Math.min(sorted.length - 1, Math.floor(q * sorted.length))] ?? NaN;
    return { p50: at(0.5), p99: at(0.99) };
  }
}

/** What palpate-viewer and palpate-server do for a page, for one organ and one tool, in this page's worker. */
export class OrganHost {
  private held: { position: Vec3; goal: Vec3; sinceMs: number; givenMs: number } | undefined;
  private tool: 0 | 1 | 2 = 0; // as Organ.tick() says
  private released = false;
  private seq = 0;
  private ticks = 0;
  private overruns = 0;
  private fields = { count: 0, sinceMs: clockMs() }; // evaluated since the last status
  private flags = 0;
  private lastMs = clockMs();
  private ticksLeft = 0; // until rest
  private unshown = false;
  private wakes = 0; // timer
  private frameMs = 1000 / USUAL_HZ;
  private nextFrameMs = 0;
  private answers: Answer[] = [];
  private readonly tickUs = new Times();

  constructor(
    private readonly organ: Organ,
    private readonly name: string,
    private readonly told: Told,
  ) {
    const { regions, ...surface } = organ.mesh();
    const names = regions.map(({ name, youngs_modulus }) => ({ name, youngs_modulus }));
    told.said({ type: 'state', server: 'serving', text: `${this.name}, in this page`, others: '' });
    told.said({ type: 'mesh', tip_radius: TIP_RADIUS, model_id: organ.id, regions: names, certificate: certificateLine(organ.certificate) });
    told.mesh({ ...surface, regions, revision: 1 });
    this.status();
    setInterval(() => this.status(), STATUS_MS);
    this.wakeOften();
  }

  say(message: { type: string; [field: string]: unknown }): void {
    if (message.type === 'grab') this.grab();
    else if (message.type === 'release') this.release();
    else if (message.type === 'set') this.set(message);
    else if (message.type === 'rate') this.rate(Number(message['hz']));
  }

  /** @param hz  of fields; what is not a number is ignored */
  private rate(hz: number): void {
    if (Number.isNaN(hz)) return;
    this.frameMs = 1000 / Math.min(MOST_HZ, Math.max(LEAST_HZ, hz));
    this.nextFrameMs = 0;
    this.wakeOften();
  }

  /** Four times for each field: a wake-up costs as much as several ticks. */
  private wakeOften(): void {
    clearInterval(this.wakes);
    this.wakes = self.setInterval(() => this.wake(), Math.min(MOST_WAKE_MS, Math.max(LEAST_WAKE_MS, this.frameMs / 4)));
  }

  /** The tool's target until the next call, from which it goes on to its goal; undefined: no tool is held. */
  hold(position: Vec3 | undefined, goal = position): void {
    this.held = position && goal && { position, goal, sinceMs: clockMs(), givenMs: -Infinity };
  }

  private grab(): void {
    this.wake(); // what ended before is told before
    this.released = false;
    this.organ.grab(this.lastMs);
    this.ticksLeft = REST_TICKS;
    this.told.said({ type: 'tool', granted: true, tool_id: 0, message: '' });
  }

  private release(): void {
    this.held = undefined;
    this.released = true;
    this.organ.release();
  }

  private set(message: { [field: string]: unknown }): void {
    const { modelModulus, modulus, friction } = this.organ.parameters;
    const factor = message['youngs_factor'], mu = message['friction'];
    const wrong = this.organ.set(typeof factor === 'number' ? factor * modelModulus : modulus, typeof mu === 'number' ? mu : friction);
    this.ticksLeft = REST_TICKS;
    this.told.said({ type: 'parameters', request: message['request'], accepted: wrong === '', message: wrong });
    this.status();
  }

  private status(): void {
    const { modelModulus, modulus, friction, forceLimit } = this.organ.parameters;
    this.told.said({
      type: 'status',
      device: 'this page',
      rate_hz: 1000 / TICK_MS,
      ticks: this.ticks,
      overruns: this.overruns,
      fields_hz: this.fieldsHz(),
      tick_us: this.tickUs.summary,
      flags: this.flags,
      tip_radius: TIP_RADIUS,
      youngs_modulus: modulus,
      model_youngs_modulus: modelModulus,
      friction,
      force_limit: forceLimit,
      parameters_open: true,
      viewer: { pages: 1 },
    });
    this.flags = 0;
  }

  private fieldsHz(): number {
    const { count, sinceMs } = this.fields;
    this.fields = { count: 0, sinceMs: clockMs() };
    return (1000 * count) / Math.max(1, this.fields.sinceMs - sinceMs);
  }

  /** The ticks since the last wake-up, and a frame when it is time, also for a page that still draws: it gets the newest. */
  private wake(): void {
    const nowMs = clockMs();
    const due = Math.floor((nowMs - this.lastMs) / TICK_MS);
    const ticks = Math.min(due, MOST_TICKS, this.ticksLeft);
    if (this.ticksLeft > 0) this.overruns += Math.max(0, due - MOST_TICKS);
    this.lastMs += (due - ticks) * TICK_MS; // a page that stood still goes on from now
    this.aim(nowMs);
    for (let i = 0; i < ticks; ++i) this.tick((this.lastMs += TICK_MS));
    if (this.unshown && nowMs >= this.nextFrameMs) this.frame(nowMs);
  }

  private aim(nowMs: number): void {
    const { held } = this;
    if (!held || nowMs - held.sinceMs >= HOLD_MS || nowMs - held.givenMs < TARGET_MS) return;
    held.givenMs = nowMs;
    this.organ.target(later(held.position, held.goal, nowMs - held.sinceMs), this.lastMs);
  }

  private tick(tickMs: number): void {
    const start = performance.now();
    const was = this.tool;
    this.tool = this.organ.tick(tickMs);
    this.tickUs.add(1000 * (performance.now() - start));
    ++this.ticks;
    this.unshown = true;
    this.ticksLeft = this.tool === 0 ? this.ticksLeft - 1 : REST_TICKS;
    if (was !== 0 && this.tool === 0)
      this.told.said({ type: 'tool', granted: false, tool_id: null, message: this.released ? 'released' : 'no target came for 250 ms' });
    if (this.tool !== 2) return;
    const tool = this.organ.tool();
    this.flags |= tool.flags;
    this.answers.push({
      toolId: 0,
      flags: tool.flags,
      tUs: 1000 * tickMs,
      force: Math.hypot(...tool.force),
      penetration: tool.penetration,
      wakeupUs: 0,
      stiffness: this.organ.stiffness,
      forceVector: vector(tool.force),
      tip: vector(tool.tip),
    });
    if (this.answers.length > MOST_ANSWERS) this.answers.splice(0, MOST_ANSWERS / 2);
  }

  private frame(nowMs: number): void {
    this.nextFrameMs = Math.max(this.nextFrameMs + this.frameMs, nowMs - this.frameMs); // after a late frame the next comes sooner
    this.unshown = false;
    const u = this.organ.surface();
    if (u) ++this.fields.count;
    const tool = this.organ.tool();
    let most = 0;
    if (u) for (const x of u) most = Math.max(most, Math.abs(x));
    const scale = most > 0 ? most / 32767 : 1e-9;
    const displacement = new Int16Array(u?.length ?? 0);
    if (u) for (let i = 0; i < u.length; ++i) displacement[i] = Math.round(u[i]! / scale);
    this.told.frame({
      seq: ++this.seq,
      meshRevision: 1,
      nodes: displacement.length / 3,
      sampleUs: 1000 * nowMs,
      sentUs: 1000 * nowMs,
      surfaceSeq: this.seq,
      scale,
      displacement,
      tools: this.tool === 2
        ? [
            {
              id: 0,
              state: tool.state,
              flags: tool.flags,
              mine: true,
              tip: vector(tool.tip),
              proxy: vector(tool.proxy),
              anchor: vector(tool.anchor),
              force: vector(tool.force),
              penetration: tool.penetration,
              domainRadius: tool.domainRadius,
            },
          ]
        : [],
      answers: this.answers.splice(0),
    });
  }
}
