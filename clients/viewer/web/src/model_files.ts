// SPDX-License-Identifier: Apache-2.0
import { element, setText } from './page';

const SIGNATURE = [0x89, 0x48, 0x44, 0x46, 0x0d, 0x0a, 0x1a, 0x0a]; // of HDF5

export interface Named {
  readonly address: string; // absolute; empty: none
  readonly wrong: string; // for people: the name is no address; else empty
  readonly exported: boolean; // whether palpate-viewer --export wrote this page
}

function addressOf(name: string, page: Document): string {
  try {
    return new URL(name, page.location.href).href;
  } catch {
    return '';
  }
}

/** The model that the page's address names, or else the one that palpate-viewer --export wrote into the page. */
export function namedModel(page: Document): Named {
  const exported = page.querySelector<HTMLMetaElement>('meta[name="palpate-model"]');
  const name = new URLSearchParams(page.location.search).get('model') || exported?.content || '';
  const address = name && addressOf(name, page);
  return { address, wrong: name && !address ? `?model=${name} is no address` : '', exported: exported !== null };
}

/** Model files that people drop onto the page or choose. */
export class ModelFiles {
  private readonly input = element('model-file', HTMLInputElement);
  private readonly button = element('open', HTMLButtonElement);
  private readonly offer_ = element('offer', HTMLDivElement);
  private wanted = false;
  private timer = 0;

  constructor(
    private readonly take: (file: File) => void,
    private readonly refuse: (text: string) => void,
  ) {
    for (const button of [this.button, element('offer-open', HTMLButtonElement)])
      button.addEventListener('click', () => this.input.click());
    this.input.addEventListener('change', () => {
      void this.given(this.input.files?.[0]);
      this.input.value = ''; // the same file may be chosen again
    });
    // A file that is dropped must never open in the page's place.
    addEventListener('dragover', (event) => this.over(event));
    addEventListener('dragleave', (event) => !event.relatedTarget && this.mark(false));
    addEventListener('drop', (event) => this.dropped(event));
  }

  /** From now on files are taken: this page has no viewer. */
  want(): void {
    this.wanted = true;
    this.button.hidden = false;
  }

  /** Asks for a file in the organ's place. @param why  for people; empty: asks no more  @param afterMs  unless told otherwise until then */
  offer(why: string, afterMs = 0): void {
    clearTimeout(this.timer);
    this.offer_.hidden = afterMs > 0 || why === '' || !this.wanted;
    setText(element('offer-text', HTMLParagraphElement), why);
    if (afterMs > 0) this.timer = window.setTimeout(() => this.offer(why), afterMs);
  }

  private over(event: DragEvent): void {
    event.preventDefault();
    this.mark(this.wanted);
  }

  private dropped(event: DragEvent): void {
    event.preventDefault();
    this.mark(false);
    void this.given(event.dataTransfer?.files[0]);
  }

  private mark(on: boolean): void {
    document.documentElement.toggleAttribute('data-drop', on);
  }

  private async given(file: File | undefined): Promise<void> {
    if (!file) return;
    if (!this.wanted) return this.refuse('This page shows the organ of a palpate-server. Pages that palpate-viewer --export writes open model files.');
    const start = new Uint8Array(await file.slice(0, SIGNATURE.length).arrayBuffer().catch(() => new ArrayBuffer(0)));
    if (SIGNATURE.every((byte, i) => start[i] === byte)) this.take(file);
    else this.refuse(`${file.name} is no model file: it does not begin as HDF5 does.`);
  }
}
