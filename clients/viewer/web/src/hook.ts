// SPDX-License-Identifier: Apache-2.0
import type { App } from './app';
import { toolToShow } from './readout';
import { norm, type Vec3 } from './vec';

/** window.palpate.figures(), for tests and the curious: the panel's numbers, read-only. */
export function figuresOf(app: App): Record<string, unknown> {
  const now = performance.now();
  const { drawn, received, decodedMs, shownMs, frames, pictures } = app.figures;
  const tool = toolToShow(app.frame_?.tools ?? []);
  const mesh = tool && app.view?.toolMesh(tool.id);
  return {
    state: app.server,
    nodes: app.view?.surface.mesh.nodes ?? 0,
    meshRevision: app.view?.surface.mesh.revision ?? 0,
    organSeenMs: app.figures.organSeenMs,
    frames,
    pictures,
    picturesPerSecond: drawn.rate(now),
    framesPerSecond: received.rate(now),
    bytesPerFrame: received.mean(),
    decodedMs: { p50: decodedMs.percentile(0.5), p99: decodedMs.percentile(0.99), count: decodedMs.count },
    shownMs: { p50: shownMs.percentile(0.5), p99: shownMs.percentile(0.99), count: shownMs.count },
    roundTripMs: app.line.tripMs,
    largestDisplacement: app.view?.surface.largest ?? 0,
    pressing: app.hand.pressing,
    toolId: app.hand.toolId ?? null,
    tools: app.frame_?.tools.length ?? 0,
    force: tool ? norm(tool.force) : 0,
    penetration: tool?.penetration ?? 0,
    contact: tool?.state ?? 0,
    flags: tool?.flags ?? 0,
    gap: mesh ? mesh.gap : null,
    inForce: app.parameters.inForce,
    samples: tool ? app.curves.strips.of(tool.id).length : 0,
    felt: app.view ? { low: app.view.felt.low, high: app.view.felt.high } : null,
    tickUs: app.panel.status?.['tick_us'] ?? null,
    fieldsPerSecond: app.panel.status?.['fields_hz'] ?? null,
    ticks: app.panel.status?.['ticks'] ?? null,
    kept: app.panel.kept ?? null,
    drawnBy: app.stage.drawnBy,
    pixelRatio: app.stage.pixelRatio,
  };
}

export function giveHook(app: App): void {
  const hook = { figures: () => figuresOf(app), strip: () => app.curves.strips.all(), felt: (point: Vec3) => app.view?.felt.at(point) };
  Object.defineProperty(window, 'palpate', { value: Object.freeze(hook) });
}
