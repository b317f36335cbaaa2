// SPDX-License-Identifier: Apache-2.0
import { element, setText } from './page';
import type { Pressed } from './last_press';
import type { Answer, Mesh, Shape } from './protocol';
import { adviceOf, Contact, noduleOf, scoreOf, TRAIN_S } from './training';

type Goal = 'nodule' | 'below';

/** The card of goals: starts one, says how it goes, and scores it. */
export class TrainingCard {
  private mesh: Mesh | undefined;
  private nodule: Shape | undefined;
  private goal: Goal | undefined; // that runs
  private contact = new Contact(1);
  private sinceMs = 0;
  private readonly choice = element('goal', HTMLSelectElement);
  private readonly limit = element('goal-limit', HTMLInputElement);
  private readonly limitText = element('goal-limit-text', HTMLOutputElement);
  private readonly start = element('goal-start', HTMLButtonElement);
  private readonly here = element('goal-here', HTMLButtonElement);
  private readonly words = element('goal-words', HTMLParagraphElement);

  /**
   * @param lastPress  of this page, for the place that is named
   * @param blind      told whether the inside may not be looked at
   * @param say        to screen readers
   */
  constructor(
    private readonly lastPress: () => Pressed | undefined,
    private readonly blind: (on: boolean) => void,
    private readonly say: (text: string) => void,
  ) {
    this.start.addEventListener('click', () => (this.goal ? this.stop('Given up.') : this.begin()));
    this.here.addEventListener('click', () => this.named());
    for (const input of [this.choice, this.limit]) input.addEventListener('input', () => this.write());
    this.write();
  }

  /** Another organ, or none. */
  organ(mesh: Mesh | undefined): void {
    if (this.goal) this.stop('The organ is gone.');
    this.mesh = mesh;
    this.nodule = mesh && noduleOf(mesh);
    for (const option of this.choice.options) if (option.value === 'nodule') option.disabled = !this.nodule;
    if (!this.nodule) this.choice.value = 'below';
    this.write();
  }

  /** Nobody answers any more: what is left of a goal would be none. */
  end(): void {
    if (this.goal) this.stop('The server is gone.');
  }

  /** Call with this page's answers. */
  feel(answers: readonly Answer[]): void {
    if (!this.goal || answers.length === 0) return;
    this.contact.add(answers);
    const { seconds, shareAbove, points } = this.contact;
    if (this.goal === 'below' && seconds >= TRAIN_S) return this.stop(`Done: ${points} of 100 points, at most ${this.most()}.`);
    const rest = this.goal === 'below' ? `, ${Math.ceil(TRAIN_S - seconds)} s to go` : '';
    setText(this.words, `${Math.round(100 * (1 - shareAbove))} % of the contact below ${this.limitWords()}, at most ${this.most()}${rest}.`);
  }

  private begin(): void {
    if (!this.mesh) return setText(this.words, 'There is no organ to train on yet.');
    this.goal = this.choice.value === 'nodule' ? 'nodule' : 'below';
    this.contact = new Contact(Number(this.limit.value));
    this.sinceMs = performance.now();
    this.blind(this.goal === 'nodule');
    this.write();
    this.tell(
      this.goal === 'nodule'
        ? `Palpate, stay below ${this.limitWords()}, then press where the nodule is and choose "It is here".`
        : `Press for ${TRAIN_S} s in all, below ${this.limitWords()} and above a fifth of it.`,
    );
  }

  private named(): void {
    const last = this.lastPress();
    const advice = adviceOf(this.contact);
    if (!this.mesh || !this.nodule || !last || advice) return this.tell(advice ?? 'Press on the organ first.');
    const { off, points } = scoreOf(this.mesh, this.nodule, last.spot, this.contact);
    const seconds = Math.round((performance.now() - this.sinceMs) / 1000);
    this.stop(`${points} of 100 points: ${(1000 * off).toFixed(0)} mm off, in ${seconds} s, at most ${this.most()}.`);
  }

  private stop(words: string): void {
    this.goal = undefined;
    this.blind(false);
    this.write();
    this.tell(words);
  }

  private tell(words: string): void {
    setText(this.words, words);
    this.say(words);
  }

  private most(): string {
    return `${this.contact.strongest.toFixed(1)} N`;
  }

  private limitWords(): string {
    return `${Number(this.limit.value).toFixed(1)} N`;
  }

  private write(): void {
    setText(this.limitText, this.limitWords());
    this.limit.setAttribute('aria-valuetext', `${Number(this.limit.value).toFixed(1)} newtons`);
    setText(this.start, this.goal ? 'Give up' : 'Start');
    this.here.hidden = this.goal !== 'nodule';
    this.choice.disabled = this.limit.disabled = this.goal !== undefined;
  }
}
