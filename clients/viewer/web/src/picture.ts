// SPDX-License-Identifier: Apache-2.0
import { download, timeStamp } from './page';
import { themeColour } from './theme';

/** Saves what a canvas shows, on the page's ground, as PNG. @param trouble  told why not, for people */
export function savePicture(canvas: HTMLCanvasElement, trouble: (text: string) => void): void {
  const picture = document.createElement('canvas');
  picture.width = canvas.width;
  picture.height = canvas.height;
  const draw = picture.getContext('2d');
  if (!draw) return trouble('This browser cannot save pictures.');
  draw.fillStyle = themeColour('--ground');
  draw.fillRect(0, 0, picture.width, picture.height);
  draw.drawImage(canvas, 0, 0);
  picture.toBlob((png) => (png ? download(`palpate-${timeStamp()}.png`, png) : trouble('The picture could not be made.')));
}
