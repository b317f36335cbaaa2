// SPDX-License-Identifier: Apache-2.0
import type { Organ } from '../../../../core/wasm/organ.mjs';
import { clockMs } from './clock';
import type { Said } from './connection';
import { STATE_FREE, type Answer, type Frame, type Mesh } from './protocol';
import type { Vec3 } from './vec';

const TIP_RADIUS = 0.005; // m
const TICK_MS = 1;
const WAKE_MS = 4; // between wake-ups, each of which makes up for the time since the last one
const MOST_TICKS = 25; // of one wake-up: a page that stood still does not catch up
const STATUS_MS = 1000;
const REST_MS = 300; // ticks after the last tool, in which forces and fields fade
const SHORTEST_FRAME_MS = 16;

export interface Told {
  said(said: Said): void;
  mesh(mesh: Mesh): void;
  frame(frame: Frame): void;
}

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
  private held: Vec3 | undefined;
  private driven = false;
  private seq = 0;
  private ticks = 0;
  private overruns = 0;
  private flags = 0;
  private lastMs = clockMs();
  private restFromMs = clockMs();
  private nextFrameMs = 0;
  private pageIsBusy = false;
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
    told.said({ type: 'mesh', tip_radius: TIP_RADIUS, model_id: organ.id, regions: names });
    told.mesh({ ...surface, regions, revision: 1 });
    this.status();
    setInterval(() => this.status(), STATUS_MS);
    setInterval(() => this.wake(), WAKE_MS);
  }

  say(message: { type: string; [field: string]: unknown }): void {
    if (message.type === 'grab') this.told.said({ type: 'tool', granted: true, tool_id: 0, message: '' });
    else if (message.type === 'release') this.release();
    else if (message.type === 'set') this.set(message);
  }

  hold(position: Vec3 | undefined): void {
    this.held = position;
  }

  /** The page has drawn the last frame. */
  taken(): void {
    this.pageIsBusy = false;
  }

  private release(): void {
    this.held = undefined;
    this.organ.release();
  }

  private set(message: { [field: string]: unknown }): void {
    const { modelModulus, modulus, friction } = this.organ.parameters;
    const factor = message['youngs_factor'], mu = message['friction'];
    const wrong = this.organ.set(typeof factor === 'number' ? factor * modelModulus : modulus, typeof mu === 'number' ? mu : friction);
    this.restFromMs = clockMs();
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

  /** The ticks since the last wake-up, and a frame where the page waits for one. */
  private wake(): void {
    const nowMs = clockMs();
    const due = Math.floor((nowMs - this.lastMs) / TICK_MS);
    if (this.held || this.driven) this.restFromMs = nowMs;
    if (nowMs - this.restFromMs > REST_MS) {
      this.lastMs = nowMs;
      return;
    }
    if (this.held) this.organ.target(this.held, nowMs);
    const ticks = Math.min(due, MOST_TICKS);
    this.overruns += due - ticks;
    for (let i = ticks; i > 0; --i) this.tick(nowMs - (i - 1) * TICK_MS);
    this.lastMs = due > ticks ? nowMs : this.lastMs + ticks * TICK_MS;
    if (ticks > 0 && !this.pageIsBusy && nowMs >= this.nextFrameMs) this.frame(nowMs);
  }

  private tick(nowMs: number): void {
    const start = performance.now();
    const was = this.driven;
    this.driven = this.organ.tick(nowMs);
    this.tickUs.add(1000 * (performance.now() - start));
    ++this.ticks;
    if (was && !this.driven) this.told.said({ type: 'tool', granted: false, tool_id: null, message: 'released' });
    if (!this.driven) return;
    const tool = this.organ.tool();
    this.flags |= tool.flags;
    const size = Math.hypot(...tool.force);
    const n = tool.force.map((f) => f / size);
    const K = tool.stiffness;
    const felt = [0, 1, 2].reduce((sum, i) => sum - n[i]! * (K[3 * i]! * n[0]! + K[3 * i + 1]! * n[1]! + K[3 * i + 2]! * n[2]!), 0);
    this.answers.push({
      toolId: 0,
      flags: tool.flags,
      tUs: 1000 * nowMs,
      force: size,
      penetration: tool.penetration,
      wakeupUs: 0,
      stiffness: tool.state === STATE_FREE || !(size > 0) ? 0 : felt,
    });
  }

  private frame(nowMs: number): void {
    this.nextFrameMs = nowMs + SHORTEST_FRAME_MS;
    this.pageIsBusy = true;
    const u = this.organ.surface();
    const tool = this.organ.tool();
    let most = 0;
    if (u) for (const x of u) most = Math.max(most, Math.abs(x));
    const scale = most > 0 ? most / 32767 : 1e-9;
    const displacement = new Int16Array(u?.length ?? 0);
    if (u) for (let i = 0; i < u.length; ++i) displacement[i] = Math.round(u[i]! / scale);
    const vector = (v: readonly number[]): Vec3 => [v[0]!, v[1]!, v[2]!];
    this.told.frame({
      seq: ++this.seq,
      meshRevision: 1,
      nodes: displacement.length / 3,
      sampleUs: 1000 * nowMs,
      sentUs: 1000 * nowMs,
      surfaceSeq: this.seq,
      scale,
      displacement,
      tools: this.driven
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
