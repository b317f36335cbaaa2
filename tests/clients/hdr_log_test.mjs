// SPDX-License-Identifier: Apache-2.0
// The log of palpate-latency --hdr, read by npm's hdr-histogram-js.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { Bench, bin } from '../viewer/support/processes.mjs';

const page = createRequire(new URL('../../clients/viewer/web/', import.meta.url));
try {
  page.resolve('hdr-histogram-js');
} catch {
  console.log('SKIPPED: npm could not fetch hdr-histogram-js');
  process.exit(0);
}
const { HistogramLogReader } = page('hdr-histogram-js');
let bench;
before(async () => {
  bench = await Bench.open();
  await bench.server(bench.model(2));
});
after(() => bench.close());

test('another reader finds the quantiles and the maximum that the report has', () => {
  const log = join(bench.folder, 'latency.hdr');
  const ran = spawnSync(bin('palpate-latency'), ['--seconds', '2', '--json', '--fields', '--hdr', log, '--domain', String(bench.domain)], {
    encoding: 'utf8',
  });
  assert.equal(ran.status, 0, ran.stderr);
  const report = JSON.parse(ran.stdout);
  const reader = new HistogramLogReader(readFileSync(log, 'utf8'));
  const seen = [];
  for (let histogram = reader.nextIntervalHistogram(); histogram; histogram = reader.nextIntervalHistogram()) {
    const told = report[`${histogram.tag}_us`];
    assert.equal(histogram.totalCount, told.count, histogram.tag);
    const same = (ns, us) => assert.ok(Math.abs(ns / 1000 / us - 1) < 1e-3, `${histogram.tag}: ${ns} ns, ${us} us`);
    same(histogram.getValueAtPercentile(50), told.p50);
    same(histogram.getValueAtPercentile(99), told.p99);
    same(histogram.maxValue, told.max);
    seen.push(histogram.tag);
  }
  assert.deepEqual(seen, ['pose_to_force', 'answered_pose_to_force', 'pose_to_field', 'wakeup', 'tick']);
});
