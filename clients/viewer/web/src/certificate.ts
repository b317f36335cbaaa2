// SPDX-License-Identifier: Apache-2.0
const LEAST_SAMPLES = 59; // docs/design.md, Certificate
const MOST_BYTES = 65536; // of a certificate in a model file
const UNKNOWN = 'not certified: the certificate in the file has a form that this page does not know';

const asRecord = (value: unknown): Record<string, unknown> => (typeof value === 'object' && value !== null ? (value as Record<string, unknown>) : {});

/** @throws Error  no number, or one below the least or above the most */
function within(value: unknown, least: number, most: number): number {
  if (typeof value !== 'number' || !(value >= least && value <= most)) throw new Error('out of range');
  return value;
}

/** Nothing where the certificate claims none. @throws Error */
function boundOf(error: unknown): number | undefined {
  const bound = error === null ? null : asRecord(error)['bound_95_95'];
  return bound === null ? undefined : within(bound, 0, Number.MAX_VALUE);
}

const percent = (share: number, digits: number): string => (100 * share).toFixed(digits);

/** @throws Error  where it has no such form */
function lineOf(c: Record<string, unknown>): string {
  const samples = within(c['samples'], 0, 2e6);
  const reach = Number((1000 * within(c['travel'], Number.MIN_VALUE, 1)).toPrecision(4));
  const share = within(c['certified_area_fraction'], 0, 1);
  const [force, field] = [boundOf(c['force_error']), boundOf(c['field_error'])];
  const bounds = samples >= LEAST_SAMPLES;
  if (!Number.isInteger(samples) || (force !== undefined) !== bounds || (field !== undefined) !== bounds)
    throw new Error('bounds that do not go with its samples');
  if (force === undefined || field === undefined)
    return `not certified for touches to ${reach} mm: ${samples} samples in the domain, a bound takes ${LEAST_SAMPLES}`;
  return (
    `certified for touches to ${reach} mm: of touches in the domain, 95 % are within ${percent(force, 2)} % in force and 95 % ` +
    `within ${percent(field, 2)} % in field, each with 95 % confidence; ${percent(share, 1)} % of touches are in the domain`
  );
}

/**
 * What a model's certificate says, in one line for people: the words of tools/program/certificate_line.cpp.
 * @param certificate  attribute of the model file, any text; empty: it has none
 */
export function certificateLine(certificate: string): string {
  if (!certificate) return 'not certified: the model file does not state how far its answers are off';
  if (new TextEncoder().encode(certificate).length > MOST_BYTES) return UNKNOWN;
  try {
    return lineOf(asRecord(JSON.parse(certificate)));
  } catch {
    return UNKNOWN;
  }
}
