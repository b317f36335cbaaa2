// SPDX-License-Identifier: Apache-2.0
import { download, timeStamp } from './page';
import { themeColour } from './theme';

/** What stands below the organ in a saved picture. */
export interface Caption {
  readonly title: string; // what it is of
  readonly lines: readonly string[]; // force, parameters, date
  readonly scale: { readonly stops: readonly string[]; readonly low: string; readonly high: string } | undefined;
  readonly swatches: readonly { readonly colour: string; readonly words: string }[];
  readonly rule: { readonly pixels: number; readonly words: string }; // CSS pixels
}

const MARGIN = 16; // CSS pixels, like all below
const LINE = 20;
const BAR = 180;

/** Draws in CSS pixels on a canvas of more. */
class Sheet {
  constructor(
    readonly draw: CanvasRenderingContext2D,
    readonly width: number,
  ) {}

  text(words: string, x: number, y: number, { bold = false, quiet = false, align = 'left' as CanvasTextAlign } = {}): number {
    this.draw.font = `${bold ? '600 ' : ''}14px system-ui, "Liberation Sans", "DejaVu Sans", sans-serif`;
    this.draw.fillStyle = themeColour(quiet ? '--quiet' : '--ink');
    this.draw.textAlign = align;
    this.draw.textBaseline = 'middle';
    this.draw.fillText(words, x, y, this.width - 2 * MARGIN);
    return this.draw.measureText(words).width;
  }

  ramp(scale: NonNullable<Caption['scale']>, x: number, y: number): number {
    const bar = this.draw.createLinearGradient(x, 0, x + BAR, 0);
    scale.stops.forEach((stop, i) => bar.addColorStop(i / (scale.stops.length - 1), stop));
    this.draw.fillStyle = bar;
    this.draw.fillRect(x, y - 14, BAR, 10);
    this.text(scale.low, x, y + 6, { quiet: true });
    this.text(scale.high, x + BAR, y + 6, { quiet: true, align: 'right' });
    return BAR + 2 * MARGIN;
  }

  rule({ pixels, words }: Caption['rule'], y: number): void {
    const right = this.width - MARGIN;
    this.draw.strokeStyle = themeColour('--ink');
    this.draw.lineWidth = 1.5;
    this.draw.beginPath();
    for (const [x, dy] of [[right - pixels, -6], [right - pixels, 0], [right, 0], [right, -6]] as const) this.draw.lineTo(x, y + dy);
    this.draw.stroke();
    this.text(words, right - pixels / 2, y + 12, { align: 'center' });
  }

  swatches(swatches: Caption['swatches'], from: number, y: number): void {
    let x = from;
    for (const { colour, words } of swatches) {
      this.draw.fillStyle = colour;
      this.draw.fillRect(x, y - 7, 14, 14);
      x += 20 + this.text(words, x + 20, y, { quiet: true }) + MARGIN;
    }
  }
}

/** Height of what stands below the organ, CSS pixels. */
const heightOf = (caption: Caption): number => 2 * MARGIN + LINE * (4 + caption.lines.length);

function write(sheet: Sheet, caption: Caption, top: number): void {
  sheet.rule(caption.rule, top - MARGIN - 12);
  let y = top + MARGIN;
  sheet.text(caption.title, MARGIN, y, { bold: true });
  for (const line of caption.lines) sheet.text(line, MARGIN, (y += LINE));
  y += LINE + 10;
  const x = MARGIN + (caption.scale ? sheet.ramp(caption.scale, MARGIN, y) : 0);
  if (sheet.width - x > 2 * BAR || !caption.scale) sheet.swatches(caption.swatches, x, y - 9);
  else sheet.swatches(caption.swatches, MARGIN, y + 1.5 * LINE);
}

/**
 * Saves what a canvas shows, on the page's ground, as PNG, with legend, scale, force and date.
 * @param trouble  told why not, for people
 */
export function savePicture(canvas: HTMLCanvasElement, caption: Caption, trouble: (text: string) => void): void {
  const ratio = canvas.width / Math.max(1, canvas.clientWidth);
  const picture = document.createElement('canvas');
  picture.width = canvas.width;
  picture.height = canvas.height + Math.round(ratio * heightOf(caption));
  const draw = picture.getContext('2d');
  if (!draw) return trouble('This browser cannot save pictures.');
  draw.fillStyle = themeColour('--ground');
  draw.fillRect(0, 0, picture.width, picture.height);
  draw.drawImage(canvas, 0, 0);
  draw.fillStyle = themeColour('--card');
  draw.fillRect(0, canvas.height, picture.width, picture.height);
  draw.scale(ratio, ratio);
  write(new Sheet(draw, canvas.clientWidth), caption, canvas.clientHeight);
  picture.toBlob((png) => (png ? download(`palpate-${timeStamp()}.png`, png) : trouble('The picture could not be made.')));
}
