// SPDX-License-Identifier: Apache-2.0
type Vector = readonly [number, number, number];

export interface Shape {
  readonly nodes: number;
  readonly positions: Float32Array;
  readonly triangles: Uint32Array;
}

export interface Organ {
  readonly id: string;
  readonly nodes: number;
  readonly certificate: string; // of the model file; empty: it has none
  readonly parameters: { modelModulus: number; modulus: number; friction: number; forceLimit: number };
  mesh(): Shape & {
    readonly accessible: Uint8Array;
    readonly clamped: Uint8Array;
    readonly regions: readonly (Shape & { readonly name: string; readonly youngs_modulus: number })[];
  };
  set(modulus: number, friction: number): string;
  grab(nowMs: number): void;
  target(position: Vector, nowMs: number): void;
  release(): void;
  tick(nowMs: number): 0 | 1 | 2;
  readonly stiffness: number;
  tool(): {
    readonly tip: number[];
    readonly flags: number;
    readonly state: number;
    readonly force: number[];
    readonly anchor: number[];
    readonly proxy: number[];
    readonly domainRadius: number;
    readonly penetration: number;
  };
  surface(): Float32Array | undefined;
}

export function makeOrgan(makeModule: unknown, settings: object, hdf5: unknown, bytes: ArrayBuffer, name: string, tipRadius?: number): Promise<Organ>;
