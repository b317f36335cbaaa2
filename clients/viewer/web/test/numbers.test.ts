// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { certificateLine } from '../src/certificate';
import { viewerUs, ViewerClock } from '../src/clock';
import { CLAMPED, DISPLACEMENT, encodedOf, labOf, linearOf, niceCeiling, NO_ANSWER, NOT_FELT, rgbOf, STIFFNESS, TISSUE, type ColourMap } from '../src/colours';
import { viewerAddress } from '../src/connection';
import { FLAGS } from '../src/flag_list';
import { flagsOfStatus, flagWords, RecentFlags } from '../src/flags';
import { lateWords } from '../src/late_words';
import { codeIn } from '../src/login';
import { namedModel } from '../src/model_files';
import { Quality } from '../src/quality';
import { Recent } from '../src/recent';
import { csvOf } from '../src/csv';
import { settingsOf, UNKNOWN } from '../src/settings';
import { Strip, Strips } from '../src/strip';
import { StripView } from '../src/strip_view';
import type { Vec3 } from '../src/vec';

const answer = (tUs: number, toolId = 0, force = 1) => ({ toolId, flags: 0, tUs, force, penetration: 0.001, wakeupUs: 0, stiffness: 0,
  forceVector: [0, 0.5, -0.25] as Vec3, tip: [0.01, 0, 0.02] as Vec3 });

test('late ticks are told by cause, the most frequent first', () => {
  const none = { own_work: 0, page_fault: 0, preempted: 0, stopped: 0, host_steal: 0, clock_step: 0, unknown: 0, preempted_by: '' };
  assert.equal(lateWords(none), 'none');
  assert.equal(lateWords({}), '–');
  assert.equal(lateWords({ ...none, unknown: 2, preempted: 10, host_steal: 1, preempted_by: 'hog (7)' }), '13: another thread 10, unknown 2');
});

test('the clock takes its offset from the shortest round trip', () => {
  const clock = new ViewerClock(4);
  assert.ok(Number.isNaN(viewerUs(clock.reading(), 0)));
  clock.learn(0, 40, 5_000_000 + 35_000); // 35 of the 40 ms were on the way there
  clock.learn(100, 102, 5_000_000 + 101_000);
  clock.learn(200, 260, 5_000_000 + 203_000);
  assert.equal(clock.reading().tripMs, 2);
  assert.equal(viewerUs(clock.reading(), 1000), 6_000_000);
  for (const t of [1, 2, 3, 4]) clock.learn(1000 * t, 1000 * t + 8, 1e6 * t + 4000); // the viewer was restarted
  assert.equal(viewerUs(clock.reading(), 1000), 1_000_000);
  clock.learn(10, 5, 0); // an answer before the question teaches nothing
  assert.equal(clock.reading().tripMs, 8);
});

test('percentiles and rates are of the last seconds', () => {
  const recent = new Recent(1000);
  for (let i = 1; i <= 100; ++i) recent.add(i, i);
  assert.deepEqual([recent.percentile(0.5), recent.percentile(0.99), recent.percentile(1)], [50, 99, 100]);
  assert.equal(recent.rate(100, 50), 50 / 0.05);
  recent.add(5000, 7);
  assert.equal(recent.percentile(1), 7);
  assert.ok(Number.isNaN(new Recent().percentile(0.5)));
});

test('a strip keeps ten seconds, in order, once', () => {
  const strip = new Strip();
  for (let i = 0; i <= 30_000; ++i) strip.add(answer(1000 * i), UNKNOWN);
  strip.add(answer(29_000_000), UNKNOWN); // late
  assert.ok(strip.length >= 10_000 && strip.length < 10_020, `${strip.length}`);
  assert.equal(strip.last()?.tUs, 30_000_000);
  assert.equal(strip.since(29_999_000).length, 2);
});

test('what is saved is the last ten seconds, also of a tool that left before', () => {
  const strips = new Strips();
  strips.add([answer(1_000_000, 1), answer(2_000_000, 1), answer(11_500_000, 0)]);
  assert.deepEqual(strips.all().map((s) => s.tUs).sort(), [11_500_000, 2_000_000].sort());
});

test('saved as CSV: SI units, time from the first sample, all tools, pose, force vector and the parameters in force', () => {
  const strips = new Strips();
  strips.add([answer(5_000_000), answer(5_001_000, 2, 0.5)]);
  strips.add([answer(5_002_000)], settingsOf({ type: 'status', youngs_modulus: 5000, friction: null, force_limit: 20, tip_radius: 0.005 }));
  const where = '0.00000,0.500000,-0.250000,0.0100000,0.00000,0.0200000';
  assert.deepEqual(csvOf(strips.all()).split('\n'), [
    't_s,tool_id,force_N,penetration_m,flags,force_x_N,force_y_N,force_z_N,tip_x_m,tip_y_m,tip_z_m,' +
      'youngs_modulus_Pa,friction,coupling_stiffness_N_per_m,coupling_damping_N_s_per_m,force_limit_N,tip_radius_m',
    `0.000000,0,1.00000,0.00100000,0,${where},,,,,,`,
    `0.001000,2,0.500000,0.00100000,0,${where},,,,,,`,
    `0.002000,0,1.00000,0.00100000,0,${where},5000.00,inf,,,20.0000,0.00500000`,
    '',
  ]);
});

test('the curve of a press stays when the tool is gone, until the next begins', () => {
  const [strips, view] = [new Strips(), new StripView()];
  const press = (fromUs: number, tool: number): void => {
    for (let i = 0; i <= 100; ++i) strips.add([answer(fromUs + 1000 * i, tool)]);
  };
  assert.deepEqual(view.at(undefined, strips, 0).samples, []);
  press(1_000_000, 3);
  assert.deepEqual([view.at(3, strips, 1_100_000).edgeUs, view.at(3, strips, 1_100_000).mode], [1_100_000, 'live']);
  const minutesLater = view.at(undefined, strips, 600_000_000);
  assert.deepEqual([minutesLater.samples.length, minutesLater.mode], [101, 'held']);
  assert.ok(minutesLater.edgeUs < 1_500_000, `${minutesLater.edgeUs}`);
  press(700_000_000, 2);
  const next = view.at(2, strips, 700_100_000);
  assert.deepEqual([next.mode, next.samples[0]!.tUs], ['live', 700_000_000]);
});

test('a paused curve is what it was, whatever comes', () => {
  const [strips, view] = [new Strips(), new StripView()];
  strips.add([answer(1_000_000), answer(1_001_000)]);
  const before = view.at(0, strips, 1_002_000);
  view.pause(strips);
  for (let i = 1; i < 20; ++i) strips.add([answer(1_002_000 + 1_000_000 * i)]);
  strips.clear();
  assert.deepEqual(view.at(undefined, strips, 30_000_000), { ...before, mode: 'paused' });
  assert.equal(view.saved(strips).length, 2);
  view.goOn();
  assert.deepEqual(view.saved(strips), []);
});

test('the flags are those of the IDL', () => {
  const idl = readFileSync(join(process.env['PALPATE_WEB'] ?? '.', '../../../idl/palpate.idl'), 'utf8');
  const wire = [...idl.matchAll(/const unsigned long FLAG_(\w+) = (\d+);/g)].map(([, name, bit]) => `${name} ${bit}`);
  assert.ok(wire.length > 10);
  assert.deepEqual(FLAGS.map(({ name, bit }) => `${name} ${bit}`), wire);
  assert.deepEqual(flagWords(1 | 32).map(({ words }) => words), ['force held at its limit']);
});

test('a certificate is one line, and a bad one is named', () => {
  const good = { samples: 60, travel: 0.007, certified_area_fraction: 0.787, force_error: { bound_95_95: 0.00223 }, field_error: { bound_95_95: 0.00778 } };
  const line = (changed: object): string => certificateLine(JSON.stringify({ ...good, ...changed }));
  assert.equal(
    line({}),
    'certified for touches to 7 mm: of touches in the domain, 95 % are within 0.22 % in force and 95 % within 0.78 % in field, ' +
      'each with 95 % confidence; 78.7 % of touches are in the domain',
  );
  const few = { samples: 6, force_error: null, field_error: { bound_95_95: null } };
  assert.equal(line(few), 'not certified for touches to 7 mm: 6 samples in the domain, a bound takes 59');
  assert.equal(certificateLine(''), 'not certified: the model file does not state how far its answers are off');
  const wrong = [{ travel: 2 }, { samples: 60.5 }, { samples: 6 }, { field_error: null }, { certified_area_fraction: undefined }];
  for (const text of ['{', '[]', 'null', ' '.repeat(65536) + line({}), ...wrong.map((changed) => JSON.stringify({ ...good, ...changed }))])
    assert.match(certificateLine(text), /^not certified: the certificate in the file has a form/);
});

test('a tool that nobody holds is no news', () => {
  assert.deepEqual(flagWords(flagsOfStatus(8 | 128 | 65536)).map(({ words }) => words), ['ticks were missed']);
});

test('a flag of one tick can be read for seconds, and then goes', () => {
  const flags = new RecentFlags();
  flags.add(8 | 65536, 1000);
  flags.add(1, 2000);
  flags.add(8, 4000);
  assert.equal(flags.at(4000), 1 | 8 | 65536);
  assert.equal(flags.at(5500), 1 | 8);
  assert.equal(flags.at(7000), 8);
  assert.equal(flags.at(60_000), 0);
  flags.add(65536, 60_000);
  flags.clear(); // the server went
  flags.add(flagsOfStatus(NaN), 60_000); // of a status without flags
  assert.equal(flags.at(60_000), 0);
});

// Dichromats: F. Vienot, H. Brettel, J. Mollon, "Digital video colourmaps for checking the legibility of displays by
// dichromats", Color Research and Application 24 (1999), for red and green; tritan after Brettel et al. 1997, simplified.
const SEEN: Record<string, (c: Vec3) => Vec3> = {
  protanope: ([r, g, b]) => [0.11238 * r + 0.88762 * g, 0.11238 * r + 0.88762 * g, 0.00401 * r - 0.00401 * g + b],
  deuteranope: ([r, g, b]) => [0.29275 * r + 0.70725 * g, 0.29275 * r + 0.70725 * g, -0.02234 * r + 0.02234 * g + b],
  tritanope: ([r, g, b]) => [r, 0.8 * g + 0.2 * b, 0.8 * g + 0.2 * b],
  everybody: (c) => c,
};

const tellsApart = (map: ColourMap, see: (c: Vec3) => Vec3): number => {
  const labs = Array.from({ length: 11 }, (_, i) => labOf(see(map.at(i / 10)).map((c) => Math.max(0, c)) as unknown as Vec3));
  return Math.min(...labs.slice(1).map((lab, i) => Math.hypot(...lab.map((c, k) => c - labs[i][k]))));
};

// 0.02 in OKLab is about the least difference that people see side by side.
test('colour-blind users tell every tenth of a scale from the next', () => {
  for (const [who, see] of Object.entries(SEEN))
    for (const [name, map] of Object.entries({ DISPLACEMENT, STIFFNESS }))
      assert.ok(tellsApart(map, see) > 0.025, `${name} ${who}: ${tellsApart(map, see)}`);
});

test('clamp, what cannot be touched, what was not felt and tissue are told apart by everybody', () => {
  for (const [who, see] of Object.entries(SEEN)) {
    const colours = [rgbOf(CLAMPED), rgbOf(NO_ANSWER), NOT_FELT, TISSUE.at(0), TISSUE.at(0.5), TISSUE.at(1)];
    const labs = colours.map((c) => labOf(see(c).map((x) => Math.max(0, x)) as unknown as Vec3));
    const apart = (a: number, b: number): number => Math.hypot(...labs[a].map((c, k) => c - labs[b][k]));
    for (const [a, b] of [[0, 1], [0, 2], [1, 2], [0, 4], [1, 3], [1, 4], [1, 5], [2, 5]])
      assert.ok(apart(a, b) > 0.06, `${who}: ${a} and ${b}: ${apart(a, b)}`);
  }
});

test('lightness alone tells the order', () => {
  const lightness = (map: ColourMap): number[] => Array.from({ length: 21 }, (_, i) => labOf(map.at(i / 20))[0]);
  const down = lightness(DISPLACEMENT);
  const up = lightness(STIFFNESS);
  assert.ok(down.slice(1).every((l, i) => l < down[i]) && up.slice(1).every((l, i) => l > up[i]));
});

test('sRGB there and back', () => {
  for (const c of [0, 0.002, 0.2, 1]) assert.ok(Math.abs(linearOf(encodedOf(c)) - c) < 1e-12);
});

test('scales end at 1, 2, 5', () => {
  assert.deepEqual([0.3, 1, 1.2, 2.5, 7, 0].map(niceCeiling).map((x) => Number(x.toPrecision(3))), [0.5, 1, 2, 5, 10, 1]);
});

test('the line is beside the page, and the address brings no secret to it', () => {
  const page = { protocol: 'http:', host: 'h:1', pathname: '/', search: '?token=secret', hash: '#code=secret' };
  assert.equal(viewerAddress(page), 'ws://h:1/ws');
  assert.equal(viewerAddress({ ...page, protocol: 'https:', pathname: '/sub/index.html' }), 'wss://h:1/sub/ws');
});

test('a code is in the fragment that palpate-viewer prints, and nowhere else', () => {
  assert.equal(codeIn('#code=0af3'), '0af3');
  for (const other of ['', '#', '#0af3', '?code=0af3', '#token=0af3']) assert.equal(codeIn(other), '');
});

test('the address names a model before the export does, and an exported page is told by its meta element', () => {
  const page = (href: string, exported?: string) =>
    ({ location: new URL(href), querySelector: () => (exported === undefined ? null : { content: exported }) }) as unknown as Document;
  assert.deepEqual(namedModel(page('http://h/a/')), { address: '', exported: false, wrong: '' });
  assert.deepEqual(namedModel(page('http://h/a/', '')), { address: '', exported: true, wrong: '' });
  assert.deepEqual(namedModel(page('http://h/a/index.html', './b%20c.h5')), { address: 'http://h/a/b%20c.h5', exported: true, wrong: '' });
  assert.deepEqual(namedModel(page('http://h/a/?model=http://[')), { address: '', exported: false, wrong: '?model=http://[ is no address' });
  assert.deepEqual(namedModel(page('http://h/a/?model=d.h5', './b.h5')), { address: 'http://h/a/d.h5', exported: true, wrong: '' });
  assert.equal(namedModel(page('http://h/a/?model=http://other/e.h5')).address, 'http://other/e.h5');
});

test('a picture that took long leaves as much time to others; with graphics hardware none does', () => {
  const next = (software: boolean, took: number): number => {
    const quality = new Quality(1, software);
    quality.picture(1000);
    quality.finished(1000 + took);
    for (let ms = 1000 + took; ; ++ms) if (quality.due(ms)) return ms - 1000;
  };
  assert.deepEqual([5, 38, 100].map((took) => next(true, took)), [38, 38, 162]);
  assert.equal(next(true, 1e6), 1e6 + 1000);
  assert.equal(next(false, 100), 100);
});

test('what is at rest is told by how long pictures take, and how long the next one may not come', () => {
  const quality = new Quality(2, true);
  assert.deepEqual([quality.restMs, quality.waitMs(0)], [300, 0]);
  quality.picture(1000);
  quality.finished(1200);
  assert.deepEqual([quality.restMs, quality.waitMs(1200), quality.waitMs(5000)], [800, 162, 0]);
  assert.deepEqual([quality.rested(1800), quality.rested(1801)], [false, true]);
});
