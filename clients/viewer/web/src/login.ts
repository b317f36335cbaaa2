// SPDX-License-Identifier: Apache-2.0
import { element, setText } from './page';

const CODE = '#code=';
const SECRET = /^[\w-]+$/;
const DOOR_TIMES = 4;
const DOOR_WAIT_MS = 500;

/** The code in an address that palpate-viewer printed. Browsers send no fragment to anyone. */
export function codeIn(fragment: string): string {
  return fragment.startsWith(CODE) ? fragment.slice(CODE.length) : '';
}

/** What answers here: a palpate-viewer, which wants its token first or not; another web server; nothing that tells. */
export type Door = 'asks' | 'open' | 'other' | 'silent';

export async function door(): Promise<Door> {
  try {
    const answer = await fetch('./login', { cache: 'no-store' });
    if (answer.status === 404 || answer.status === 405) return 'other';
    if (!answer.ok) return 'silent'; // a proxy, or a web server that is busy, says nothing of what is behind
    const said = (await answer.json().catch(() => null)) as { needed?: unknown } | null;
    return typeof said?.needed !== 'boolean' ? 'other' : said.needed ? 'asks' : 'open';
  } catch {
    return 'silent';
  }
}

/** door(), asked again for some seconds while nothing tells. */
export async function doorAtLast(): Promise<Door> {
  for (let times = 1; ; ++times) {
    const here = await door();
    if (here !== 'silent' || times === DOOR_TIMES) return here;
    await new Promise((resolve) => setTimeout(resolve, DOOR_WAIT_MS));
  }
}

/** Gives token or code for a cookie, which scripts cannot read. @return why not, for people; empty when it let us in */
export async function bring(secret: string): Promise<string> {
  if (!SECRET.test(secret)) return 'a token has letters, digits, - and _';
  try {
    const headers = { Authorization: `Bearer ${secret}` };
    const answer = await fetch('./login', { method: 'POST', headers, cache: 'no-store' });
    return answer.ok ? '' : await answer.text();
  } catch {
    return 'no word from palpate-viewer';
  }
}

/**
 * Resolves once the viewer lets this page in: by its cookie, the code of its address, or the token that people give.
 * @param asked  whether it wants its token first; a viewer that does not answer wants nothing yet
 */
export async function admit(asked: boolean): Promise<void> {
  const code = codeIn(location.hash);
  if (code) history.replaceState(null, '', location.pathname + location.search);
  addEventListener('hashchange', () => codeIn(location.hash) && location.reload());
  if (!asked) return;
  const refused = code && (await bring(code));
  if (!code || refused) await ask(refused);
}

/** Shows the form until a token fits. */
function ask(text: string): Promise<void> {
  const dialog = element('login', HTMLDialogElement);
  const token = element('token', HTMLInputElement);
  const message = element('login-message', HTMLParagraphElement);
  setText(message, text);
  dialog.addEventListener('cancel', (event) => event.preventDefault());
  dialog.showModal();
  return new Promise((resolve) => {
    element('login-form', HTMLFormElement).addEventListener('submit', (event) => {
      event.preventDefault();
      void bring(token.value.trim()).then((refused) => {
        setText(message, refused);
        token.value = '';
        if (refused) return token.focus();
        dialog.close();
        resolve();
      });
    });
  });
}
