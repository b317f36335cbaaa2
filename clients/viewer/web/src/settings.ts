// SPDX-License-Identifier: Apache-2.0
import type { Said } from './connection';
import { numberIn } from './page';

/** The parameters in force; NaN: not said. */
export interface Settings {
  readonly youngsModulus: number; // Pa
  readonly friction: number;
  readonly couplingStiffness: number; // N/m
  readonly couplingDamping: number; // N s/m
  readonly forceLimit: number; // N
  readonly tipRadius: number; // m
}

export const UNKNOWN: Settings = {
  youngsModulus: NaN, friction: NaN, couplingStiffness: NaN, couplingDamping: NaN, forceLimit: NaN, tipRadius: NaN,
};

/** @param status  of the viewer, in which infinity is null */
export function settingsOf(status: Said): Settings {
  const value = (name: string): number => (status[name] === null ? Infinity : numberIn(status, name));
  return {
    youngsModulus: value('youngs_modulus'),
    friction: value('friction'),
    couplingStiffness: value('coupling_stiffness'),
    couplingDamping: value('coupling_damping'),
    forceLimit: value('force_limit'),
    tipRadius: value('tip_radius'),
  };
}
