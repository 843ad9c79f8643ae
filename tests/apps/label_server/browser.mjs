// A server and a headless browser, for tests of the page.
import { spawn, spawnSync } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { createServer } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const [program, makeLot, pageFolder] = process.argv.slice(2);
const kFlags = [
  '--no-sandbox',
  '--disable-gpu',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
  '--disable-quic',
  '--no-first-run',
];

function skip(reason) {
  console.log(`not run: ${reason}`);
  process.exit(process.exitCode || 77);  // an earlier part of this process may have failed
}

export function check(condition, what) {
  if (!condition) throw new Error(`not so: ${what}`);
  console.log(`ok: ${what}`);
}

export async function until(condition, what, ms = 30000) {
  const end = Date.now() + ms;
  while (!(await condition())) {
    if (Date.now() > end) throw new Error(`did not happen: ${what}`);
    await new Promise((later) => setTimeout(later, 50));
  }
}

function freePort() {
  return new Promise((done) => {
    const server = createServer().listen(0, '127.0.0.1', () => {
      const { port } = server.address();
      server.close(() => done(port));
    });
  });
}

let started;
let keeps = false;

/** Tests of this process share one browser, until it is closed: its start takes as long as many a test. */
export function keepBrowser() {
  keeps = true;
}

async function sharedBrowser() {
  const chromium = ['/usr/bin/chromium', '/usr/bin/chromium-browser'].find(existsSync);
  if (!chromium) skip('there is no chromium');
  if (!existsSync(join(pageFolder, 'node_modules/playwright-core'))) skip('the page was not built');
  const { chromium: launcher } = createRequire(`${pageFolder}/`)('playwright-core');
  started ??= await launcher.launch({ executablePath: chromium, args: kFlags });
  return started;
}

export async function closeBrowser() {
  await started?.close();
  started = undefined;
}

/** Runs `test({page, spaces, server, browser, makeLot})` with everything it needs, and cleans up. */
export async function withPage(test, lot = []) {
  const browser = await sharedBrowser();
  const folder = mkdtempSync(join(tmpdir(), 'label_page_'));
  const map = join(folder, 'lot.gpkg');
  const made = spawnSync(makeLot, [map, ...lot], { encoding: 'utf8' });
  if (made.status !== 0) throw new Error(`make_lot: ${made.stderr}`);
  const spaces = made.stdout
    .trim()
    .split('\n')
    .map((line) => line.split(' ').map(Number));
  const server = new Server(map, await freePort(), join(folder, 'token'));
  process.on('exit', () => server.process?.kill('SIGKILL'));
  for (const signal of ['SIGTERM', 'SIGINT']) process.on(signal, () => process.exit(1));
  let page;
  try {
    await server.start();
    page = await (await browser.newContext({ viewport: { width: 1400, height: 900 } })).newPage();
    page.on('pageerror', (fault) => {
      console.log(`error in the page: ${fault.message}`);
      process.exitCode = 1;
    });
    await page.goto(server.address);
    await stored(page);
    await test({ page, spaces, server, browser, makeLot });
  } catch (fault) {
    if (page) console.log('the page said:', await page.textContent('#hint'), '|', await page.textContent('#status'));
    throw fault;
  } finally {
    for (const context of browser.contexts()) await context.close();
    if (!keeps) await closeBrowser();
    await server.kill('SIGKILL');
    rmSync(folder, { recursive: true, force: true });
  }
}

class Server {
  constructor(map, port, tokenFile) {
    Object.assign(this, { map, port, tokenFile });
  }

  async start() {
    const options = ['-m', this.map, '--port', this.port, '--token-file', this.tokenFile, '--who', 'ann'];
    // A file-size limit makes the write fail, as a full disk does; it sends no signal.
    const shell = ['-c', 'trap "" XFSZ; exec "$0" "$@"', program, 'label', ...options.map(String)];
    this.process = spawn('/bin/sh', shell, { stdio: ['ignore', 'pipe', 'inherit'] });
    this.ended = new Promise((done) => this.process.on('exit', (status) => done(status)));
    let text = '';
    this.process.stdout.on('data', (bytes) => (text += bytes));
    // Loading the program takes long on a busy machine with a cold disk.
    await until(() => text.includes('token='), 'the server starts', 120000);
    this.address = text.match(/http:\S+/)[0];
  }

  /** No file of the server grows beyond that size, as on a full disk; 'unlimited' makes room. */
  limitFiles(bytes) {
    const made = spawnSync('prlimit', ['--pid', this.process.pid, `--fsize=${bytes}:unlimited`].map(String));
    if (made.status !== 0) throw new Error(`prlimit: ${made.stderr}`);
  }

  async kill(signal) {
    this.process?.kill(signal);
    return this.ended;
  }
}

export async function stored(page) {
  await until(async () => (await page.textContent('#status')) === 'All changes saved', 'the page is ready');
}

/** Where a place of the map is on the screen. */
export async function onScreen(page, x, y) {
  await until(() => page.evaluate(() => 'place' in document.querySelector('#map').dataset), 'a map');
  return page.evaluate(
    ([px, py]) => {
      const map = document.querySelector('#map');
      const [cx, cy, resolution] = map.dataset.place.split(' ').map(Number);
      const box = map.getBoundingClientRect();
      return [
        box.x + box.width / 2 + (px - cx) / resolution,
        box.y + box.height / 2 - (py - cy) / resolution,
      ];
    },
    [x, y],
  );
}

export async function clickPlace(page, x, y) {
  const [u, v] = await onScreen(page, x, y);
  await page.mouse.move(u, v);
  await page.mouse.click(u, v);
}

/** The corners of a box [x, y, heading, length, width] that three clicks give. */
export function threeClicks([x, y, heading, length, width]) {
  const at = (l, w) => [
    x + Math.cos(heading) * l - Math.sin(heading) * w,
    y + Math.sin(heading) * l + Math.cos(heading) * w,
  ];
  return [at(-length / 2, -width / 2), at(length / 2, -width / 2), at(0, width / 2)];
}

export const labelsOf = (page) =>
  page.evaluate(async () => (await (await fetch('api/labels')).json()).labels);
