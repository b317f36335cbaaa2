// SPDX-License-Identifier: Apache-2.0
import { Absence } from './absence';
import { Announcer } from './announcer';
import { viewerAddress, type Received, type Said } from './connection';
import { Curves } from './curves';
import { DepthSlider } from './depth_slider';
import { Figures } from './figures';
import { flagsOfStatus, RecentFlags } from './flags';
import { Hand } from './hand';
import { Keeping } from './keeping';
import { Keys } from './keys';
import { Legend } from './legend';
import { Line, type LineListener } from './line';
import { admit, door, doorAtLast } from './login';
import { ModelFiles, namedModel } from './model_files';
import { forget } from './offline';
import { Notice } from './notice';
import type { Colouring } from './organ';
import { OrganView } from './organ_view';
import { element, followInputKind, numberIn, setText } from './page';
import { isOfThisVersion } from './page_version';
import { Panel } from './panel';
import { Parameters } from './parameters';
import { Pictures } from './pictures';
import { Pointers } from './pointer';
import type { Frame, Mesh } from './protocol';
import { Practice } from './practice';
import { Readout, toolToShow } from './readout';
import { RegionList } from './region_list';
import { Saving, type Shown } from './saving';
import { settingsOf } from './settings';
import { Stage } from './stage';
import { Theme, themeColour } from './theme';
import { Vibration } from './vibration';

const WORDS_MS = 40; // between chart and words
const HIDDEN_HZ = 1;
const SOFTWARE_HZ = 30; // fields of an organ in this page, which draws fewer pictures then
const SOFTWARE_TARGET_MS = 40; // there the organ's own worker leads the tool from one target to the next
const FIRST_WORDS_MS = 300; // after an organ came: its picture is first
const SLOW_MS = 30_000; // of reading a model, after which another one is asked for
const USUAL_TIP = 0.005; // m, until the viewer sends the tip radius

/** The page: listens to the viewer, draws, and lets people press. */
export class App implements LineListener {
  readonly figures = new Figures();
  readonly curves = new Curves();
  view: OrganView | undefined;
  frame_: Frame | undefined;
  server = { level: 'wait', text: 'connecting' };
  readonly stage: Stage;
  readonly line: Line;
  readonly hand: Hand;
  readonly parameters: Parameters;
  private colouring: Colouring = 'plain';
  private tipRadius = USUAL_TIP;
  private usualHz = 60;
  private lineOpen = false;
  private nextWordsMs = 0;
  private organName = '';
  private readonly canvas = element('organ', HTMLCanvasElement);
  private readonly pictures: Pictures;
  private readonly readout = new Readout();
  private readonly legend: Legend;
  private readonly saving: Saving;
  private readonly notices = new Notice();
  private readonly absence = new Absence();
  private readonly announcer = new Announcer();
  private readonly depth = new DepthSlider();
  private isAlone = false;
  private readonly regionList = new RegionList((on) => this.view?.showInside(on));
  readonly panel: Panel;
  private readonly flags = new RecentFlags();
  private readonly vibration = new Vibration();
  private readonly modelFiles = new ModelFiles((file) => this.open(file), (text) => this.notices.show(text));
  private readonly practice = new Practice(this.announcer, (blind) => this.regionList.hide(blind));
  private readonly keeping = new Keeping(() => this.hand.pressing, (why) => (this.panel.kept = why));

  constructor() {
    this.stage = new Stage(this.canvas);
    this.line = new Line(this);
    this.panel = new Panel(this.figures, this.line, this.stage);
    this.parameters = new Parameters(this.line);
    const organ = () => this.view && { surface: this.view.surface, tipRadius: this.tipRadius };
    this.hand = new Hand(this.stage, this.line, this.depth, () => this.absence.why, organ, (text) => this.notices.show(text));
    this.legend = new Legend((colouring) => this.setColouring(colouring), () => this.regionList.lines());
    this.saving = new Saving(this.canvas, this.stage, this.legend, () => this.shown(), (text) => this.notices.show(text));
    new Pointers(this.canvas, this.stage, this.hand);
    new Keys(this.canvas, this.stage, this.hand, () => this.saving.savePicture());
    new Theme((dark) => this.restyle(dark));
    this.pictures = new Pictures(this.stage, this.figures, () => this.line.nowUs, () => this.hand.pressing);
    new ResizeObserver(() => this.pictures.resize()).observe(this.canvas);
    followInputKind();
    document.documentElement.toggleAttribute('data-software', this.stage.software);
    element('all', HTMLElement).hidden = false; // not before, so that the browser lays it out once
    document.addEventListener('visibilitychange', () => this.seen());
    element('home', HTMLButtonElement).addEventListener('click', () => this.stage.orbit.reset());
    requestAnimationFrame((now) => this.turn(now));
    void this.begin();
  }

  /** Finds out whether a palpate-viewer is here; without one the page has an organ of its own. */
  private async begin(): Promise<void> {
    const model = namedModel(document);
    const again = model.address !== '' || Boolean(navigator.serviceWorker?.controller); // opened without a network
    const here = model.exported ? 'other' : again ? await doorAtLast() : await door();
    if (here === 'other' || (here === 'silent' && again)) return this.alone(model.wrong ? '' : model.address || this.keeping.last, model.wrong);
    if (model.address) this.notices.show('A palpate-viewer serves this page, so it shows the organ of a palpate-server, not the model named.');
    void forget();
    await admit(here === 'asks');
    this.line.open({ viewer: viewerAddress(location) });
  }

  /** @param model  its address; empty: none  @param wrong  for people: why there is none */
  private alone(model: string, wrong: string): void {
    if (this.stage.software) [this.usualHz, this.hand.targetMs] = [SOFTWARE_HZ, SOFTWARE_TARGET_MS];
    this.isAlone = true;
    this.modelFiles.want();
    this.panel.alone();
    if (model) {
      this.keeping.want(model);
      this.load(model);
    } else {
      this.setState(wrong ? 'bad' : 'wait', wrong || 'no organ');
      this.modelFiles.offer(wrong || 'There is no palpate-viewer here, and no model is named.');
      void this.keeping.keep('');
    }
  }

  private open(file: File): void {
    this.keeping.forget();
    this.load(file);
  }

  private load(model: string | File): void {
    this.line.open({ model });
    this.setState('wait', 'loading the model', 'starting');
  }

  link(open: boolean, text: string): void {
    this.lineOpen = open;
    if (open) return this.askRate();
    this.setState('bad', `${text}; trying again`, 'line');
    void door().then((here) => here === 'asks' && location.reload()); // the cookie is too old, or the token another one
  }

  said(message: Said): void {
    if (message.type === 'hello') this.greeted(message);
    else if (message.type === 'mesh') this.announced(message);
    else if (message.type === 'tool') this.hand.said(message);
    else if (message.type === 'parameters') this.parameters.answered(message);
    else if (message.type === 'status') this.status(message);
    else if (message.type === 'state') this.heardState(message);
  }

  private greeted(hello: Said): void {
    this.usualHz = numberIn(hello, 'rate_hz') || this.usualHz;
    if (!isOfThisVersion(hello, sessionStorage, () => location.reload()))
      this.setState('bad', 'this page is not of this version of palpate-viewer: load it again', 'line');
  }

  mesh(mesh: Mesh): void {
    this.hand.drop();
    this.view?.remove();
    this.curves.clear();
    this.depth.forget();
    this.practice.organ(mesh);
    const isInsideShown = this.regionList.show(mesh);
    this.pictures.resize(); // for the legend's rows; a picture before that would be drawn again
    this.view = new OrganView(mesh, this.stage, this.tipRadius);
    this.view.setAbsent(!this.serving);
    this.view.setColouring(this.colouring);
    this.view.showInside(isInsideShown);
    this.keeping.organCame();
    this.nextWordsMs = performance.now() + FIRST_WORDS_MS;
    this.pictures.hurry();
  }

  frame(frame: Frame, received: readonly Received[]): void {
    this.figures.frame(frame, received, performance.now());
    if (!this.serving) return; // the message waited while the server went
    this.frame_ = frame;
    this.view?.frame(frame);
    this.curves.add(frame);
    this.depth.feel(frame.tools.find((tool) => tool.mine));
    this.practice.frame(frame);
    this.vibration.feel(frame.tools);
    for (const { flags } of [...frame.tools, ...frame.answers]) this.flags.add(flags, performance.now());
  }

  trouble(text: string): void {
    if (this.loading) this.setState('bad', text);
    this.notices.show(text);
  }

  private get serving(): boolean {
    return this.server.level === 'good';
  }

  /** What comes in words before a mesh. */
  private announced(message: Said): void {
    this.setTip(numberIn(message, 'tip_radius'));
    this.organName = String(message['model_id'] ?? '');
    this.regionList.announce(message);
    const certificate = element('certificate', HTMLParagraphElement);
    setText(certificate, String(message['certificate'] ?? ''));
    certificate.hidden = certificate.textContent === '';
  }

  private setTip(radius: number): void {
    if (!(radius > 0)) return;
    this.tipRadius = radius;
    this.view?.setTip(radius);
  }

  /** A status counts only while the server serves: after it is gone the viewer repeats the last one. */
  private status(status: Said): void {
    if (!this.serving) return this.panel.heard({ type: 'status', viewer: status['viewer'] });
    this.setTip(numberIn(status, 'tip_radius'));
    this.curves.settings = settingsOf(status);
    this.parameters.status(status);
    this.setStiffness(this.parameters.inForce.youngsFactor);
    this.panel.heard(status);
    this.flags.add(flagsOfStatus(numberIn(status, 'flags')), performance.now());
  }

  /** @param factor  live E over the model's */
  private setStiffness(factor: number): void {
    this.regionList.scale(factor);
    this.view?.setStiffness(factor);
  }

  private heardState(message: Said): void {
    const server = String(message['server']);
    this.setState(levelOf(server), String(message['text'] ?? ''), server, Boolean(message['others']));
  }

  /** @param server  as Answering has it  @param others  whether further servers are on the domain */
  private setState(level: string, text: string, server = '', others = false): void {
    this.server = { level, text };
    const state = element('state', HTMLParagraphElement);
    state.dataset['level'] = level;
    state.title = text; // it may be cut short
    state.toggleAttribute('data-others', others);
    setText(element('state-text', HTMLSpanElement), text);
    this.absence.tell({ server, text }, this.serving, !this.isAlone);
    this.view?.setAbsent(!this.serving);
    this.announcer.news('state', text);
    this.modelFiles.offer(level === 'good' ? '' : text, level === 'bad' ? 0 : SLOW_MS);
    if (!this.serving) this.forget();
  }

  private seen(): void {
    if (document.hidden) this.hand.letGo();
    this.askRate();
  }

  /** Clears everything that a server said once it no longer serves. */
  private forget(): void {
    this.hand.drop();
    this.view?.calm();
    this.frame_ = undefined;
    this.practice.end();
    this.curves.clear();
    this.vibration.feel([]);
    this.flags.clear();
    this.parameters.absent();
    this.panel.heard(undefined);
  }

  /** A hidden page wants few frames. */
  private askRate(): void {
    if (this.lineOpen) this.line.send({ type: 'rate', hz: document.hidden ? HIDDEN_HZ : this.usualHz });
  }

  private setColouring(colouring: Colouring): void {
    this.colouring = colouring;
    this.view?.setColouring(colouring);
  }

  private restyle(dark: boolean): void {
    this.stage.setLook({ dark, floorLine: themeColour('--floor'), shadow: dark ? 0.55 : 0.28 });
    this.view?.restyle();
  }

  /** One turn of the display, and the next one. */
  private turn(nowMs: number): void {
    try {
      if (!this.loading) this.draw(nowMs);
    } finally {
      this.pictures.next((now) => this.turn(now), this.view !== undefined);
    }
  }

  /** What changed; nothing while all is at rest. */
  private draw(nowMs: number): void {
    const tool = toolToShow(this.frame_?.tools ?? []);
    const due = this.pictures.due(nowMs);
    if (due && this.view && this.pictures.update(this.view, nowMs)) {
      this.legend.write(this.view, this.stage);
      this.readout.arrow(tool, tool && this.view.toolMesh(tool.id), this.stage);
    }
    if (!due || nowMs < this.nextWordsMs) return; // the browser draws words between two pictures as a picture of their own
    this.nextWordsMs = nowMs + WORDS_MS;
    this.readout.write(tool);
    this.curves.draw(tool, this.line.nowUs);
    this.panel.write(performance.now(), this.flags.at(performance.now()));
  }

  /** Whether a model is on its way into the page: what is written has to be drawn, beside the worker that loads. */
  private get loading(): boolean {
    return this.isAlone && !this.view && this.line.isOpen && this.server.level === 'wait';
  }

  private shown(): Shown {
    const tool = toolToShow(this.frame_?.tools ?? []);
    const { settings, saved: samples } = this.curves;
    return { organ: this.organName, tool, last: this.practice.last, settings, samples };
  }
}

function levelOf(server: string): string {
  if (server === 'serving') return 'good';
  return server === 'waiting' || server === 'starting' ? 'wait' : 'bad';
}
