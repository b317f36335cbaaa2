// SPDX-License-Identifier: Apache-2.0
// palpate-server and palpate-viewer as processes, on a DDS domain that no other test has.
import { spawn, spawnSync } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';

const need = (name) => {
  const value = process.env[name];
  if (!value) throw new Error(`${name} is not set: run this by ctest`);
  return value;
};
export const bin = (program) => join(need('PALPATE_BIN'), program);

// DDS on this machine's loopback only, as tools/common.sh has it.
process.env.CYCLONEDDS_URI ??=
  '<CycloneDDS><Domain><General><Interfaces><NetworkInterface name="lo" multicast="false"/></Interfaces>' +
  '<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>' +
  '<MaxAutoParticipantIndex>30</MaxAutoParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers></Discovery>' +
  '</Domain></CycloneDDS>';

const running = new Set();
// SIGTERM, so that a script among them (tools/demo) still ends what it started itself.
process.on('exit', () => running.forEach((child) => child.kill('SIGTERM')));

/** A program that runs until it is stopped, and what it wrote. */
export class Program {
  constructor(command, args, options = {}) {
    this.name = command.split('/').pop();
    this.log = '';
    this.child = spawn(command, args, { stdio: ['ignore', 'pipe', 'pipe'], ...options });
    running.add(this.child);
    for (const stream of [this.child.stdout, this.child.stderr]) stream.on('data', (data) => (this.log += data));
    this.ended = new Promise((resolve) =>
      this.child.on('close', (code, signal) => {
        running.delete(this.child);
        resolve(signal ?? code);
      }),
    );
  }

  /** The first match in what it writes. @throws Error with its log when it ends or takes longer */
  async says(pattern, seconds = 30) {
    for (const end = Date.now() + 1000 * seconds; Date.now() < end; await sleep(20)) {
      const found = pattern.exec(this.log);
      if (found) return found;
      if (this.child.exitCode !== null) break;
    }
    throw new Error(`${this.name} did not say ${pattern}:\n${this.log}`);
  }

  /** @return exit code, or the signal's name */
  async stop(signal = 'SIGTERM') {
    this.child.kill(signal);
    return this.ended;
  }

  /** SIGTERM, and SIGKILL when the program has not ended some seconds later. */
  async end(seconds = 10) {
    const hard = setTimeout(() => this.child.kill('SIGKILL'), 1000 * seconds);
    const how = await this.stop('SIGTERM');
    clearTimeout(hard);
    return how;
  }
}

/** A domain held by a lock on a file, as the C++ tests do (tests/support/src/test_domain.cpp), until this process ends. */
async function exclusiveDomain() {
  for (let attempt = 0; attempt < 200; ++attempt) {
    const domain = 1 + Math.floor(Math.random() * 200);
    const holder = spawn('flock', ['--nonblock', `/tmp/palpate-test-domain-${domain}`, 'sh', '-c', 'echo held; cat >/dev/null'], {
      stdio: ['pipe', 'pipe', 'ignore'],
    });
    const held = await new Promise((resolve) => {
      holder.stdout.once('data', () => resolve(true));
      holder.once('close', () => resolve(false));
    });
    if (held) return { domain, let_go: () => holder.stdin.end() };
  }
  throw new Error('no free DDS domain among 1 to 200: do many tests run at once?');
}

/** A domain with a folder for models; servers and viewers in it. */
export class Bench {
  static async open() {
    const bench = new Bench();
    bench.folder = mkdtempSync(join(tmpdir(), 'palpate-viewer-test-'));
    Object.assign(bench, await exclusiveDomain());
    bench.programs = [];
    return bench;
  }

  /** The tests' round organ. @param subdivisions 4: 2562 nodes @param more  arguments of write_round_organ */
  model(subdivisions = 4, ...more) {
    const file = join(this.folder, `round${[subdivisions, ...more].join('-')}.h5`);
    const made = spawnSync(join(need('PALPATE_TEST_BIN'), 'write_round_organ'), [file, subdivisions, ...more].map(String), { encoding: 'utf8' });
    if (made.status !== 0) throw new Error(`write_round_organ: ${made.stderr}`);
    return file;
  }

  start(program, args) {
    const started = new Program(program, [...args, '--domain', String(this.domain)]);
    this.programs.push(started);
    return started;
  }

  async server(model, more = []) {
    const limits = ['--limit', 'youngs-modulus=100:1e9', '--limit', 'friction=0:2'];
    const server = this.start(bin('palpate-server'), ['--model', model, '--device', 'custom', '--surface-rate', '60', ...limits, ...more]);
    await server.says(/serving on DDS domain/);
    return server;
  }

  /** @param port 0: any */
  async viewer(port = 0, more = []) {
    const viewer = this.start(bin('palpate-viewer'), ['--port', String(port), ...more]);
    viewer.address = (await viewer.says(/page at (\S+)/))[1];
    return viewer;
  }

  async close() {
    for (const program of this.programs.reverse()) await program.end();
    this.let_go();
    rmSync(this.folder, { recursive: true, force: true });
  }
}
