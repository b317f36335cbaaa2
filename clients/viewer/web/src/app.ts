// SPDX-License-Identifier: Apache-2.0
import { viewerAddress, type Received, type Said } from './connection';
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
import type { Colouring } from './organ';
import { OrganView } from './organ_view';
import { download, element, followInputKind, numberIn, setText, timeStamp } from './page';
import { Panel } from './panel';
import { Parameters } from './parameters';
import { Pointers } from './pointer';
import type { Frame, Mesh, Tool } from './protocol';
import { savePicture } from './picture';
import { Quality } from './quality';
import { Readout, toolToShow } from './readout';
import { RegionList } from './region_list';
import { Stage } from './stage';
import { csvOf, Strips } from './strip';
import { StripChart } from './strip_chart';
import { Theme, themeColour } from './theme';
import { Vibration } from './vibration';

const PANEL_MS = 250;
const CHART_MS = 40;
const EMPTY_MS = 100; // between looks at a page without an organ
const NOTICE_MS = 5000;
const HIDDEN_HZ = 1;
const SOFTWARE_HZ = 30; // fields of an organ in this page, which draws fewer pictures then
const SLOW_MS = 30_000; // of reading a model, after which another one is asked for
const USUAL_TIP = 0.005; // m, until the viewer sends the tip radius

/** The page: listens to the viewer, draws, and lets people press. */
export class App implements LineListener {
  readonly figures = new Figures();
  readonly strips = new Strips();
  view: OrganView | undefined;
  frame_: Frame | undefined;
  server = { level: 'wait', text: 'connecting' };
  readonly stage: Stage;
  readonly line: Line;
  readonly hand: Hand;
  readonly parameters: Parameters;
  private colouring: Colouring = 'displacement';
  private tipRadius = USUAL_TIP;
  private usualHz = 60;
  private lineOpen = false;
  private nextPanel = 0;
  private nextChart = 0;
  private noticeTimer = 0;
  private readonly canvas = element('organ', HTMLCanvasElement);
  private readonly quality: Quality;
  private readonly chart = new StripChart(element('strip', HTMLCanvasElement));
  private readonly readout = new Readout();
  private readonly legend: Legend;
  private readonly regionList = new RegionList((on) => this.view?.showInside(on));
  readonly panel: Panel;
  private readonly flags = new RecentFlags();
  private readonly vibration = new Vibration();
  private readonly modelFiles = new ModelFiles((file) => this.open(file), (text) => this.notice(text));
  private readonly keeping = new Keeping(() => this.hand.pressing, (why) => (this.panel.kept = why));

  constructor() {
    this.stage = new Stage(this.canvas);
    this.quality = new Quality(devicePixelRatio || 1, this.stage.software);
    this.line = new Line(this);
    this.panel = new Panel(this.figures, this.line, this.stage);
    this.parameters = new Parameters(this.line);
    const organ = () => this.view && { surface: this.view.surface, tipRadius: this.tipRadius };
    this.hand = new Hand(this.stage, this.line, organ, (text) => this.notice(text));
    this.legend = new Legend((colouring) => this.setColouring(colouring));
    new Pointers(this.canvas, this.stage, this.hand);
    new Keys(this.canvas, this.stage, this.hand);
    new Theme((dark) => this.restyle(dark));
    new ResizeObserver(() => this.stage.resize(this.quality.ratio)).observe(this.canvas);
    followInputKind();
    document.addEventListener('visibilitychange', () => this.seen());
    element('home', HTMLButtonElement).addEventListener('click', () => this.stage.orbit.reset());
    element('csv', HTMLButtonElement).addEventListener('click', () => this.saveStrip());
    element('picture', HTMLButtonElement).addEventListener('click', () => this.savePicture());
    requestAnimationFrame((now) => this.turn(now));
    void this.begin();
  }

  /** Finds out whether a palpate-viewer is here; without one the page has an organ of its own. */
  private async begin(): Promise<void> {
    const model = namedModel(document);
    const again = model.address !== '' || Boolean(navigator.serviceWorker?.controller); // opened without a network
    const here = model.exported ? 'other' : again ? await doorAtLast() : await door();
    if (here === 'other' || (here === 'silent' && again)) return this.alone(model.wrong ? '' : model.address || this.keeping.last, model.wrong);
    if (model.address) this.notice('A palpate-viewer serves this page, so it shows the organ of a palpate-server, not the model named.');
    void forget();
    await admit(here === 'asks');
    this.line.open({ viewer: viewerAddress(location) });
  }

  /** @param model  its address; empty: none  @param wrong  for people: why there is none */
  private alone(model: string, wrong: string): void {
    if (this.stage.software) this.usualHz = SOFTWARE_HZ;
    this.modelFiles.want();
    this.panel.alone();
    if (model) {
      this.keeping.want(model);
      this.line.open({ model });
    } else {
      this.setState(wrong ? 'bad' : 'wait', wrong || 'no organ');
      this.modelFiles.offer(wrong || 'There is no palpate-viewer here, and no model is named.');
      void this.keeping.keep('');
    }
  }

  private open(file: File): void {
    this.keeping.forget();
    this.line.open({ model: file });
  }

  link(open: boolean, text: string): void {
    this.lineOpen = open;
    if (open) return this.askRate();
    this.setState('bad', `${text}; trying again`);
    void door().then((here) => here === 'asks' && location.reload()); // the cookie is too old, or the token another one
  }

  said(message: Said): void {
    if (message.type === 'hello') this.usualHz = numberIn(message, 'rate_hz') || this.usualHz;
    else if (message.type === 'mesh') this.announced(message);
    else if (message.type === 'tool') this.hand.said(message);
    else if (message.type === 'parameters') this.parameters.answered(message);
    else if (message.type === 'status') this.status(message);
    else if (message.type === 'state') this.setState(levelOf(String(message['server'])), String(message['text'] ?? ''), Boolean(message['others']));
  }

  mesh(mesh: Mesh): void {
    this.hand.drop();
    this.view?.remove();
    this.strips.clear();
    this.view = new OrganView(mesh, this.stage, this.tipRadius);
    this.view.setColouring(this.colouring);
    this.view.showInside(this.regionList.show(mesh));
    this.keeping.organCame();
  }

  frame(frame: Frame, received: readonly Received[]): void {
    this.figures.frame(frame, received, performance.now());
    if (!this.serving) return; // the message waited while the server went
    this.frame_ = frame;
    this.view?.frame(frame);
    this.strips.add(frame.answers);
    this.vibration.feel(frame.tools);
    for (const { flags } of [...frame.tools, ...frame.answers]) this.flags.add(flags, performance.now());
  }

  trouble(text: string): void {
    this.notice(text);
  }

  private get serving(): boolean {
    return this.server.level === 'good';
  }

  /** What comes in words before a mesh. */
  private announced(message: Said): void {
    this.setTip(numberIn(message, 'tip_radius'));
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

  /** @param others whether further servers are on the domain */
  private setState(level: string, text: string, others = false): void {
    this.server = { level, text };
    const state = element('state', HTMLParagraphElement);
    state.dataset['level'] = level;
    state.title = text; // it may be cut short
    state.toggleAttribute('data-others', others);
    setText(element('state-text', HTMLSpanElement), text);
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
    this.strips.clear();
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

  /** One turn of the display: draws what changed, and nothing while all is at rest. */
  private turn(nowMs: number): void {
    if (this.view) requestAnimationFrame((then) => this.turn(then));
    else setTimeout(() => this.turn(performance.now()), EMPTY_MS); // no pictures: leaves the processor to the worker that loads
    const tool = toolToShow(this.frame_?.tools ?? []);
    const due = this.quality.due(nowMs);
    if (due) this.drawChanges(nowMs, tool);
    if (due && nowMs >= this.nextChart) {
      this.nextChart = nowMs + CHART_MS;
      this.readout.write(tool);
      this.chart.draw(tool && this.strips.of(tool.id), this.line.nowUs);
    }
    if (nowMs < this.nextPanel) return;
    this.nextPanel = nowMs + PANEL_MS;
    this.panel.write(performance.now(), this.flags.at(performance.now()));
  }

  private drawChanges(nowMs: number, tool: Tool | undefined): void {
    if (!this.view) return;
    const moved = this.view.update();
    const turned = this.stage.orbit.changed;
    if (!moved && !turned && !this.quality.rested(nowMs)) return;
    this.draw(nowMs, moved);
    this.legend.write(this.view, this.stage);
    this.readout.arrow(tool, tool && this.view.toolMesh(tool.id), this.stage);
  }

  private draw(nowMs: number, moved: boolean): void {
    if (this.quality.picture(nowMs)) this.stage.resize(this.quality.ratio);
    const start = performance.now();
    this.stage.draw();
    setTimeout(() => this.quality.finished(performance.now())); // behind what the browser does with the picture
    this.figures.picture(start, performance.now(), this.line.nowUs, moved);
  }

  private notice(text: string): void {
    const box = element('notice', HTMLParagraphElement);
    setText(box, text);
    box.hidden = false;
    clearTimeout(this.noticeTimer);
    this.noticeTimer = window.setTimeout(() => (box.hidden = true), NOTICE_MS);
  }

  private saveStrip(): void {
    download(`palpate-${timeStamp()}.csv`, new Blob([csvOf(this.strips.all())], { type: 'text/csv' }));
  }

  private savePicture(): void {
    this.stage.draw(); // the canvas keeps its picture until this turn ends
    savePicture(this.canvas, (text) => this.notice(text));
  }
}

function levelOf(server: string): string {
  if (server === 'serving') return 'good';
  return server === 'waiting' || server === 'starting' ? 'wait' : 'bad';
}
