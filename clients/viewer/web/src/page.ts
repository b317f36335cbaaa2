// SPDX-License-Identifier: Apache-2.0
/** The element with this id. @throws Error when index.html has none of that kind */
export function element<T extends HTMLElement>(id: string, kind: new () => T): T {
  const found = document.getElementById(id);
  if (!(found instanceof kind)) throw new Error(`index.html has no ${kind.name} #${id}`);
  return found;
}

export function setText(target: HTMLElement, text: string): void {
  if (target.textContent !== text) target.textContent = text;
}

/** Saves a file on the visitor's machine. */
export function download(name: string, content: Blob): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(content);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** For file names: 20261122-014500, local time. */
export function timeStamp(now = new Date()): string {
  const two = (n: number): string => String(n).padStart(2, '0');
  return (
    `${now.getFullYear()}${two(now.getMonth() + 1)}${two(now.getDate())}-` +
    `${two(now.getHours())}${two(now.getMinutes())}${two(now.getSeconds())}`
  );
}

/** A number of the viewer's status; NaN where it is absent or null (infinity). */
export const numberIn = (object: Record<string, unknown>, field: string): number => {
  const value = object[field];
  return typeof value === 'number' ? value : NaN;
};

/** 1000 -> "1000", 45.31 -> "45", 1.234 -> "1.2"; a dash for an unknown number. */
export function brief(value: number, digits = 1): string {
  if (!Number.isFinite(value)) return '–';
  return value.toFixed(Math.abs(value) >= 20 ? 0 : digits);
}

/** Marks the root element as typing or pointing: the organ shows its focus ring only while people type. */
export function followInputKind(): void {
  const note = (kind: string) => (): void => void (document.documentElement.dataset['input'] = kind);
  document.addEventListener('keydown', note('keys'), { capture: true });
  document.addEventListener('pointerdown', note('pointer'), { capture: true });
}
