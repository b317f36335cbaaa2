// SPDX-License-Identifier: Apache-2.0
const LEAST_SAMPLES = 59; // docs/design.md, Certificate

const asRecord = (value: unknown): Record<string, unknown> => (typeof value === 'object' && value !== null ? (value as Record<string, unknown>) : {});

/** @throws Error  no number, or one below the least or above the most */
function within(value: unknown, least: number, most: number): number {
  if (typeof value !== 'number' || !(value >= least && value <= most)) throw new Error('out of range');
  return value;
}

const bound = (error: unknown): number => within(asRecord(error)['bound_95_95'], 0, Number.MAX_VALUE);
const percent = (share: number, digits: number): string => (100 * share).toFixed(digits);

/** @throws Error  where it has no such form */
function lineOf(c: Record<string, unknown>): string {
  const reach = `${Number((1000 * within(c['travel'], Number.MIN_VALUE, 1)).toPrecision(4))} mm`;
  const samples = within(c['samples'], 0, 2e6);
  if (samples < LEAST_SAMPLES) return `not certified for touches to ${reach}: ${samples} samples, a bound takes ${LEAST_SAMPLES}`;
  const [force, field] = [bound(c['force_error']), bound(c['field_error'])].map((share) => percent(share, 2));
  const domain = percent(within(c['certified_area_fraction'], 0, 1), 0);
  return `certified to ${reach}: force within ${force} %, field within ${field} % (95 % of touches in the domain, 95 % confidence), ${domain} % of touches are in it`;
}

/**
 * What a model's certificate says, in one line for people; palpate-inspect says it at length (tools/program/certificate_line.h).
 * @param certificate  attribute of the model file, any text; empty: it has none
 */
export function certificateLine(certificate: string): string {
  if (!certificate) return 'not certified';
  try {
    return lineOf(asRecord(JSON.parse(certificate)));
  } catch {
    return 'not certified: the certificate in the file has a form that this page does not know';
  }
}
