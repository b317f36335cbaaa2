// SPDX-License-Identifier: Apache-2.0
import { recall, remember } from './memory';
import { element, setText } from './page';

const KEY = 'palpate-theme';

/** Light or dark: the system's choice, or the button's, which is remembered. */
export class Theme {
  private readonly system = matchMedia('(prefers-color-scheme: dark)');
  private readonly button = element('theme', HTMLButtonElement);

  constructor(private readonly changed: (dark: boolean) => void) {
    this.system.addEventListener('change', () => this.apply());
    this.button.addEventListener('click', () => {
      remember(KEY, this.dark ? 'light' : 'dark');
      this.apply();
    });
    this.apply();
  }

  get dark(): boolean {
    const chosen = recall(KEY);
    return chosen ? chosen === 'dark' : this.system.matches;
  }

  private apply(): void {
    document.documentElement.dataset['theme'] = this.dark ? 'dark' : 'light';
    setText(this.button, this.dark ? 'Light' : 'Dark');
    this.changed(this.dark);
  }
}

/** A colour of style.css, e.g. "--force". */
export const themeColour = (name: string): string => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
