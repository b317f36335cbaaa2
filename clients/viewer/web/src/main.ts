// SPDX-License-Identifier: Apache-2.0
import { App } from './app';
import { giveHook } from './hook';
import { element, setText } from './page';

try {
  giveHook(new App());
} catch (error) {
  // Without WebGL there is nothing to see: says so in words.
  const text = error instanceof Error ? error.message : String(error);
  element('state', HTMLParagraphElement).dataset['level'] = 'bad';
  setText(element('state-text', HTMLSpanElement), `This page cannot be shown here: ${text}`);
}
