// SPDX-License-Identifier: Apache-2.0
/** The values of the last few seconds, and their distribution. */
export class Recent {
  private readonly times: number[] = [];
  private readonly values: number[] = [];

  constructor(private readonly spanMs = 10_000) {}

  add(nowMs: number, value: number): void {
    this.times.push(nowMs);
    this.values.push(value);
    this.drop(nowMs);
  }

  clear(): void {
    this.times.length = 0;
    this.values.length = 0;
  }

  get count(): number {
    return this.values.length;
  }

  mean(): number {
    return this.count ? this.values.reduce((sum, v) => sum + v, 0) / this.count : NaN;
  }

  /** Nearest-rank percentile, share in (0, 1]; NaN without values. */
  percentile(share: number): number {
    if (!this.count) return NaN;
    const sorted = Float64Array.from(this.values).sort();
    return sorted[Math.max(0, Math.ceil(share * sorted.length) - 1)];
  }

  /** Values per second over the last `windowMs`. */
  rate(nowMs: number, windowMs = 2000): number {
    let n = 0;
    for (let i = this.times.length - 1; i >= 0 && this.times[i] > nowMs - windowMs; --i) ++n;
    return (1000 * n) / windowMs;
  }

  private drop(nowMs: number): void {
    let old = 0;
    while (old < this.times.length && this.times[old] < nowMs - this.spanMs) ++old;
    if (old > 64 || (old > 0 && old === this.times.length)) {
      this.times.splice(0, old);
      this.values.splice(0, old);
    }
  }
}
