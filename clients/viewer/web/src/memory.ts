// SPDX-License-Identifier: Apache-2.0
// What people chose in this browser. It may forbid storage; then a choice lasts until the page closes.
const here = new Map<string, string>();

export function recall(key: string): string | null {
  try {
    return localStorage.getItem(key) ?? here.get(key) ?? null;
  } catch {
    return here.get(key) ?? null;
  }
}

export function remember(key: string, value: string): void {
  here.set(key, value);
  try {
    localStorage.setItem(key, value);
  } catch {
    // storage is forbidden, see above
  }
}
