// SPDX-License-Identifier: Apache-2.0
import type { Sample } from './strip';

const HEADS = [
  't_s', 'tool_id', 'force_N', 'penetration_m', 'flags', 'force_x_N', 'force_y_N', 'force_z_N', 'tip_x_m', 'tip_y_m', 'tip_z_m',
  'youngs_modulus_Pa', 'friction', 'coupling_stiffness_N_per_m', 'coupling_damping_N_s_per_m', 'force_limit_N', 'tip_radius_m',
];

/** Empty where it is unknown. */
function cell(value: number): string {
  if (Number.isNaN(value)) return '';
  return Number.isFinite(value) ? value.toPrecision(6) : 'inf';
}

function lineOf(s: Sample, startUs: number): string {
  const { settings: p } = s;
  const parameters = [p.youngsModulus, p.friction, p.couplingStiffness, p.couplingDamping, p.forceLimit, p.tipRadius];
  return [
    ((s.tUs - startUs) / 1e6).toFixed(6), s.toolId, cell(s.force), cell(s.penetration), s.flags,
    ...[...s.forceVector, ...s.tip, ...parameters].map(cell),
  ].join();
}

/**
 * Comma-separated values (RFC 4180, without the carriage returns), SI units in the header, world frame of the mesh; t from
 * the first sample, force on the tool, tip: centre of the tip in the newest pose known.
 */
export function csvOf(samples: readonly Sample[]): string {
  const sorted = [...samples].sort((a, b) => a.tUs - b.tUs || a.toolId - b.toolId);
  const start = sorted[0]?.tUs ?? 0;
  return [HEADS.join(), ...sorted.map((s) => lineOf(s, start)), ''].join('\n');
}
