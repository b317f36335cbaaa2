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
    known.clear();
    this.changed(this.dark);
  }
}

const known = new Map<string, string>(); // colours of this theme

/** A colour of style.css, e.g. "--force". */
export function themeColour(name: string): string {
  const found = known.get(name);
  if (found) return found;
  const colour = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  known.set(name, colour);
  return colour;
}
