// SPDX-License-Identifier: Apache-2.0
/** This machine's time, ms, the same in the page and in its worker. */
export const clockMs = (): number => performance.timeOrigin + performance.now();

/**
 * The viewer's clock as seen from this page. Each ping bounds the offset by half its round trip, so the shortest recent
 * round trip is the most accurate (Cristian, "Probabilistic clock synchronization", Distributed Computing 3, 1989).
 */
export class ViewerClock {
  private readonly pings: { tripMs: number; offsetUs: number }[] = [];

  constructor(private readonly keep = 32) {}

  /** @param sentMs page's clock at the ping @param receivedMs page's clock at its answer @param viewerUs viewer's clock in between */
  learn(sentMs: number, receivedMs: number, viewerUs: number): void {
    const tripMs = receivedMs - sentMs;
    if (!(tripMs >= 0) || !Number.isFinite(viewerUs)) return;
    this.pings.push({ tripMs, offsetUs: viewerUs - 500 * (sentMs + receivedMs) });
    if (this.pings.length > this.keep) this.pings.shift();
  }

  forget(): void {
    this.pings.length = 0;
  }

  /** Offset to the page's clock, us, accurate to half the round trip; NaN before the first answer. */
  reading(): ClockReading {
    let best = this.pings[0];
    for (const ping of this.pings) if (ping.tripMs < best.tripMs) best = ping;
    return best ?? { tripMs: NaN, offsetUs: NaN };
  }
}

export interface ClockReading {
  readonly tripMs: number;
  readonly offsetUs: number;
}

/** The viewer's clock, us, when the page's was `pageMs`. */
export const viewerUs = (reading: ClockReading, pageMs: number): number => 1000 * pageMs + reading.offsetUs;
