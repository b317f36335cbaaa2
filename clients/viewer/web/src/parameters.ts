// SPDX-License-Identifier: Apache-2.0
import type { Said } from './connection';
import type { Line } from './line';
import { element, numberIn, setText } from './page';

const ASK_MS = 150; // at most one request in this time
const HELD_MS = 1500; // after this time without a hand a slider follows the server again

/** Writes an attribute that differs: to write it at all makes a browser lay out the slider. */
function put(slider: HTMLInputElement, name: 'min' | 'max' | 'value', value: number): void {
  const text = String(value);
  if (slider[name] !== text) slider[name] = text;
}

/** Narrows a slider to what the server's operator allows. `place`: where on the slider a value lies. */
function limit(slider: HTMLInputElement, status: Said, name: string, low: number, high: number, place: (value: number) => number): void {
  const limits = status['limits'] as Record<string, (number | null)[]> | undefined;
  const [lowest, highest] = limits?.[name] ?? [null, null]; // null: no bound
  put(slider, 'min', typeof lowest === 'number' ? Math.max(low, place(lowest)) : low);
  put(slider, 'max', typeof highest === 'number' ? Math.min(high, place(highest)) : high);
}

/** The sliders of organ stiffness and friction. The server decides which values are in force. */
export class Parameters {
  private readonly stiffness = element('stiffness', HTMLInputElement);
  private readonly stiffnessText = element('stiffness-text', HTMLOutputElement);
  private readonly friction = element('friction', HTMLInputElement);
  private readonly frictionText = element('friction-text', HTMLOutputElement);
  private readonly message = element('parameter-message', HTMLParagraphElement);
  private wishes: { youngs_factor?: number; friction?: number } = {};
  private request = Math.floor(Math.random() * 2 ** 40);
  private touchedMs = -Infinity;
  private askedMs = -Infinity;
  private timer = 0; // of the next request; 0: none waits
  inForce = { youngsFactor: NaN, friction: NaN };

  constructor(private readonly line: Line) {
    this.stiffness.addEventListener('input', () => this.wish({ youngs_factor: 2 ** Number(this.stiffness.value) }));
    this.friction.addEventListener('input', () => this.wish({ friction: Number(this.friction.value) }));
  }

  /** The values in force, from the viewer's status. */
  status(status: Said): void {
    const youngsFactor = numberIn(status, 'youngs_modulus') / numberIn(status, 'model_youngs_modulus');
    const friction = 'friction' in status ? (status['friction'] === null ? Infinity : numberIn(status, 'friction')) : NaN;
    this.inForce = { youngsFactor, friction };
    const closed = status['parameters_open'] !== true;
    this.stiffness.disabled = closed || !(youngsFactor > 0);
    this.friction.disabled = closed || Number.isNaN(friction);
    const model = numberIn(status, 'model_youngs_modulus');
    limit(this.stiffness, status, 'youngs_modulus', -2, 2, (E) => Math.log2(E / model));
    limit(this.friction, status, 'friction', 0, 2, (mu) => mu);
    if (performance.now() - this.touchedMs < HELD_MS) return;
    if (youngsFactor > 0) put(this.stiffness, 'value', Math.log2(youngsFactor));
    if (!Number.isNaN(friction)) put(this.friction, 'value', Math.min(2, friction));
    this.write(youngsFactor, friction);
  }

  /** The server's answer to a request. */
  answered(answer: Said): void {
    setText(this.message, answer['accepted'] === false ? `Refused: ${String(answer['message'])}` : '');
    if (answer['accepted'] === false) this.touchedMs = -Infinity; // back to the value in force
  }

  /** Without a server there is nothing to set. */
  absent(): void {
    this.stiffness.disabled = this.friction.disabled = true;
    this.inForce = { youngsFactor: NaN, friction: NaN };
    this.wishes = {};
    this.touchedMs = -Infinity;
    setText(this.message, '');
    this.write(NaN, NaN);
  }

  private wish(wish: { youngs_factor?: number; friction?: number }): void {
    Object.assign(this.wishes, wish);
    this.touchedMs = performance.now();
    this.write(2 ** Number(this.stiffness.value), Number(this.friction.value));
    if (this.timer === 0) this.timer = window.setTimeout(() => this.ask(), this.askedMs + ASK_MS - performance.now());
  }

  private ask(): void {
    this.timer = 0;
    if (Object.keys(this.wishes).length === 0) return; // the server went
    this.askedMs = performance.now();
    this.line.send({ type: 'set', request: ++this.request, ...this.wishes });
    this.wishes = {};
  }

  private write(youngsFactor: number, friction: number): void {
    const times = youngsFactor > 0 ? `× ${youngsFactor.toFixed(2)}` : '';
    setText(this.stiffnessText, times);
    this.stiffness.setAttribute('aria-valuetext', times && `${times} of the model's`);
    setText(this.frictionText, friction === Infinity ? 'never slides' : Number.isNaN(friction) ? '' : friction.toFixed(2));
  }
}
