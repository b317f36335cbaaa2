// SPDX-License-Identifier: Apache-2.0
import { element, setText } from './page';

const KEY = 'palpate-theme';

/** Light or dark: the system's choice, or the button's, which is remembered. */
export class Theme {
  private readonly system = matchMedia('(prefers-color-scheme: dark)');
  private readonly button = element('theme', HTMLButtonElement);

  constructor(private readonly changed: (dark: boolean) => void) {
    this.system.addEventListener('change', () => this.apply());
    this.button.addEventListener('click', () => {
      this.remember(this.dark ? 'light' : 'dark');
      this.apply();
    });
    this.apply();
  }

  get dark(): boolean {
    const chosen = this.chosen();
    return chosen ? chosen === 'dark' : this.system.matches;
  }

  private apply(): void {
    document.documentElement.dataset['theme'] = this.dark ? 'dark' : 'light';
    setText(this.button, this.dark ? 'Light' : 'Dark');
    this.changed(this.dark);
  }

  // A browser may forbid storage; then the choice lasts until the page closes.
  private memory: string | null = null;

  private chosen(): string | null {
    try {
      return localStorage.getItem(KEY) ?? this.memory;
    } catch {
      return this.memory;
    }
  }

  private remember(theme: string): void {
    this.memory = theme;
    try {
      localStorage.setItem(KEY, theme);
    } catch {
      // storage is forbidden, see above
    }
  }
}

/** A colour of style.css, e.g. "--force". */
export const themeColour = (name: string): string => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
