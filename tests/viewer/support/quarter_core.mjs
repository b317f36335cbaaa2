// SPDX-License-Identifier: Apache-2.0
// A quarter of a core for a program and all that it starts, by a control group. As root.
import { chmodSync, existsSync, mkdirSync, readFileSync, rmdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';

// A short period: a group that has used its share stands still until the next one, and 100 ms of that, the usual, is no slow
// machine but one that is fast and absent by turns.
const PERIOD_US = 10_000;
const QUOTA_US = PERIOD_US / 4;

const CONTROL = 'cgroup.subtree_control';

/** Of a file of a control group; none where it cannot be read. */
function wordsOf(file) {
  try {
    return readFileSync(file, 'utf8').trim().split(/\s+/);
  } catch {
    return [];
  }
}

/** Where groups with a limit of processor time can be made, and how; undefined: nowhere here. */
function kind() {
  const mounts = readFileSync('/proc/self/mounts', 'utf8').split('\n').map((line) => line.split(' '));
  const second = mounts.find(([, at, type]) => type === 'cgroup2' && wordsOf(join(at, 'cgroup.controllers')).includes('cpu'));
  const first = mounts.find(([, , type, options]) => type === 'cgroup' && options.split(',').includes('cpu'));
  // Others on the machine may have less than usual, so that the group really gets its quarter: weight, shares.
  if (second)
    return { at: second[1], passesOn: wordsOf(join(second[1], CONTROL)).includes('cpu'), settings: [['cpu.max', `${QUOTA_US} ${PERIOD_US}`], ['cpu.weight', '10000']], lifted: ['cpu.max', `max ${PERIOD_US}`] };
  if (first)
    return { at: first[1], passesOn: true, settings: [['cpu.cfs_period_us', PERIOD_US], ['cpu.cfs_quota_us', QUOTA_US], ['cpu.shares', '262144']], lifted: ['cpu.cfs_quota_us', -1] };
  return undefined;
}

/** Processor time of each of its processes so far, s. */
function timesOf(group) {
  return new Map(
    wordsOf(join(group, 'cgroup.procs')).map((process) => {
      const words = wordsOf(`/proc/${process}/stat`).join(' ').replace(/.*\) /, '').split(' '); // its name may have spaces
      return [process, (Number(words[11]) + Number(words[12])) / 100 || 0]; // utime and stime in USER_HZ, proc(5); 0: it has ended
    }),
  );
}

/** @return tells the processor time since now of the processes that are there then, s */
function clockOf(group) {
  const before = timesOf(group);
  return () => [...timesOf(group)].reduce((sum, [process, now]) => sum + Math.max(0, now - (before.get(process) ?? 0)), 0);
}

/** A group is busy until the last of its processes is gone, some time after the browser has closed. */
async function remove(group) {
  for (const end = Date.now() + 5000; ; await sleep(100))
    try {
      return rmdirSync(group);
    } catch (error) {
      if (Date.now() > end) throw error;
    }
}

/** Makes a group. @return `inside`, a program in `folder` that joins it and becomes `program`, `lift` its limit, `clock` of its processor time, and `remove`; or what it `lacks` */
export function quarterOfACore(folder, program) {
  const found = kind();
  if (!found) return { lacks: 'no control group limits processor time here' };
  const group = join(found.at, `palpate-test-${process.pid}`);
  const passOn = (sign) => found.passesOn || writeFileSync(join(found.at, CONTROL), `${sign}cpu`);
  try {
    passOn('+');
    mkdirSync(group);
    for (const [file, value] of found.settings) writeFileSync(join(group, file), String(value));
  } catch (error) {
    if (existsSync(group)) rmdirSync(group);
    if (error.path !== join(found.at, CONTROL)) passOn('-');
    return { lacks: `this user may not make a control group: ${error.message}` };
  }
  const inside = join(folder, 'inside');
  writeFileSync(inside, `#!/bin/sh\necho $$ > ${group}/cgroup.procs && exec ${program} "$@"\n`);
  chmodSync(inside, 0o755);
  const [limit, none] = found.lifted;
  return { inside, lift: () => writeFileSync(join(group, limit), String(none)), clock: () => clockOf(group), remove: async () => (await remove(group), passOn('-')) };
}
