// SPDX-License-Identifier: Apache-2.0
import { element, setText } from './page';

/** What the page is told of who answers: `server` as in PROTOCOL.md, or `line` when there is no viewer. */
export interface Answering {
  readonly server: string;
  readonly text: string; // in words
}

interface Words {
  readonly title: string;
  readonly help: string;
}

const WORDS: Record<string, Words> = {
  waiting: { title: 'No server yet', help: 'Start one on this machine or network: palpate-server --model organ.h5' },
  starting: { title: 'The server starts', help: 'The organ comes in a moment.' },
  gone: { title: 'The server is gone', help: 'Start palpate-server again; this page goes on by itself.' },
  mismatch: { title: 'The server does not fit', help: 'Server and viewer have to be of one version.' },
  line: { title: 'No line to palpate-viewer', help: 'Start palpate-viewer again; this page goes on by itself.' },
};

/** That nobody answers, said large over the organ, for as long as it is so. */
export class Absence {
  private readonly box = element('absent', HTMLDivElement);
  private answering: Answering | undefined; // undefined: not known yet

  /** @param served  whether an organ answers  @param large  false: a page with an organ of its own says it elsewhere */
  tell(answering: Answering, served: boolean, large: boolean): void {
    this.answering = served ? undefined : answering;
    this.box.hidden = served || !large;
    if (served) delete document.documentElement.dataset['absent'];
    else document.documentElement.dataset['absent'] = large ? 'large' : '';
    const { title, help } = WORDS[answering.server] ?? { title: 'Nothing answers', help: '' };
    setText(element('absent-title', HTMLParagraphElement), title);
    setText(element('absent-text', HTMLParagraphElement), answering.text);
    setText(element('absent-help', HTMLParagraphElement), help);
  }

  /** Why a press is not answered; empty: it is. */
  get why(): string {
    return this.answering ? `Nothing answers a press: ${this.answering.text}.` : '';
  }
}
