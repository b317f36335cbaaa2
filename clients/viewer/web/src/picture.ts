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
const SWATCH = 20; // with the gap to its words

const fontOf = (bold: boolean): string => `${bold ? '600 ' : ''}14px system-ui, "Liberation Sans", "DejaVu Sans", sans-serif`;

/** Draws in CSS pixels on a canvas of more. */
class Sheet {
  constructor(
    readonly draw: CanvasRenderingContext2D,
    readonly width: number,
  ) {}

  text(words: string, x: number, y: number, { bold = false, quiet = false, align = 'left' as CanvasTextAlign } = {}): void {
    this.draw.font = fontOf(bold);
    this.draw.fillStyle = themeColour(quiet ? '--quiet' : '--ink');
    this.draw.textAlign = align;
    this.draw.textBaseline = 'middle';
    this.draw.fillText(words, x, y, this.width - MARGIN - (align === 'left' ? x : MARGIN));
  }

  ramp(scale: NonNullable<Caption['scale']>, x: number, y: number): void {
    const bar = this.draw.createLinearGradient(x, 0, x + BAR, 0);
    scale.stops.forEach((stop, i) => bar.addColorStop(i / (scale.stops.length - 1), stop));
    this.draw.fillStyle = bar;
    this.draw.fillRect(x, y - 14, BAR, 10);
    this.text(scale.low, x, y + 6, { quiet: true });
    this.text(scale.high, x + BAR, y + 6, { quiet: true, align: 'right' });
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

  swatches(legend: Legend, top: number): void {
    for (const { colour, words, x, row } of legend.swatches) {
      const y = top + row * LINE;
      this.draw.fillStyle = colour;
      this.draw.fillRect(x, y - 7, 14, 14);
      this.text(words, x + SWATCH, y, { quiet: true });
    }
  }
}

/** The swatches, each with its place: beside the scale when they fit there, else in rows below it. */
interface Legend {
  readonly beside: boolean;
  readonly rows: number;
  readonly swatches: readonly { readonly colour: string; readonly words: string; readonly x: number; readonly row: number }[];
}

/** Side by side, and on from the left of the next row where the room ends. @param widths  with the gap to the next */
export function inRows(widths: readonly number[], room: number): { x: number; row: number }[] {
  let [x, row] = [0, 0];
  return widths.map((width) => {
    if (x > 0 && x + width > room) [x, row] = [0, row + 1];
    const place = { x, row };
    x += width;
    return place;
  });
}

function legendOf({ draw, width }: Sheet, { swatches, scale }: Caption): Legend {
  draw.font = fontOf(false);
  const widths = swatches.map(({ words }) => SWATCH + draw.measureText(words).width + MARGIN);
  const all = widths.reduce((sum, w) => sum + w, 0);
  const ramp = scale ? BAR + 2 * MARGIN : 0;
  const beside = all <= width - MARGIN - ramp;
  const places = inRows(widths, width - MARGIN);
  return {
    beside,
    rows: (places.at(-1)?.row ?? 0) + 1,
    swatches: swatches.map((swatch, i) => ({ ...swatch, row: places[i].row, x: MARGIN + places[i].x + (beside ? ramp : 0) })),
  };
}

/** Height of what stands below the organ, CSS pixels. */
const heightOf = (caption: Caption, legend: Legend): number => 2 * MARGIN + LINE * (3 + caption.lines.length + legend.rows);

function write(sheet: Sheet, caption: Caption, legend: Legend, top: number): void {
  sheet.rule(caption.rule, top - MARGIN - 12);
  let y = top + MARGIN;
  sheet.text(caption.title, MARGIN, y, { bold: true });
  for (const line of caption.lines) sheet.text(line, MARGIN, (y += LINE));
  y += LINE + 10;
  if (caption.scale) sheet.ramp(caption.scale, MARGIN, y);
  sheet.swatches(legend, legend.beside || !caption.scale ? y - 9 : y + 1.5 * LINE);
}

/**
 * Saves what a canvas shows, on the page's ground, as PNG, with legend, scale, force and date.
 * @param trouble  told why not, for people
 */
export function savePicture(canvas: HTMLCanvasElement, caption: Caption, trouble: (text: string) => void): void {
  const ratio = canvas.width / Math.max(1, canvas.clientWidth);
  const picture = document.createElement('canvas');
  const draw = picture.getContext('2d');
  if (!draw) return trouble('This browser cannot save pictures.');
  const sheet = new Sheet(draw, canvas.clientWidth);
  const legend = legendOf(sheet, caption);
  picture.width = canvas.width;
  picture.height = canvas.height + Math.round(ratio * heightOf(caption, legend));
  draw.fillStyle = themeColour('--ground');
  draw.fillRect(0, 0, picture.width, picture.height);
  draw.drawImage(canvas, 0, 0);
  draw.fillStyle = themeColour('--card');
  draw.fillRect(0, canvas.height, picture.width, picture.height);
  draw.scale(ratio, ratio);
  write(sheet, caption, legend, canvas.clientHeight);
  picture.toBlob((png) => (png ? download(`palpate-${timeStamp()}.png`, png) : trouble('The picture could not be made.')));
}
