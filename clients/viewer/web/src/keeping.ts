// SPDX-License-Identifier: Apache-2.0
import { recall, remember } from './memory';
import { keep } from './offline';

const LEAST_MS = 1500; // the organ comes before its copy, and on a slow machine also the first press: as long as loading took
const MODEL = `model ${new URL('./', location.href).href}`; // of this page's memory: the address of the last one named

/** The model that this page keeps for times without a network: the one that was named, once its organ is there. */
export class Keeping {
  private wanted: string | undefined; // its address

  /** @param busy  somebody presses  @param tell  hears why the page needs its network; empty: it needs none */
  constructor(
    private readonly busy: () => boolean,
    private readonly tell: (why: string) => void,
  ) {}

  /** The address of the last one named; empty: none. */
  get last(): string {
    return recall(MODEL) ?? '';
  }

  want(model: string): void {
    this.wanted = model;
  }

  /** Another file is opened: the named one is not kept. */
  forget(): void {
    this.wanted = undefined;
  }

  organCame(): void {
    const { wanted } = this;
    this.wanted = undefined;
    if (wanted === undefined) return;
    remember(MODEL, wanted); // a home screen opens the page without it
    this.soon(wanted, Math.max(LEAST_MS, performance.now()));
  }

  /** @param model  empty: the page by itself */
  async keep(model: string): Promise<void> {
    this.tell(await keep(model));
  }

  /** Copies take the processor's time: not while somebody presses. */
  private soon(model: string, afterMs: number): void {
    setTimeout(() => (this.busy() ? this.soon(model, afterMs) : void this.keep(model)), afterMs);
  }
}
