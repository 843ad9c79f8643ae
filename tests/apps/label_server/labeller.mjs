// Eyes and hands of a user at the labelling page, for car_park_labeller.mjs and pictures.mjs. The
// program counts clicks, keys and decisions. It takes their time from the keystroke-level model
// (Card, Moran and Newell 1980), and adds one fixation for each box that the user only sees.
import { spawn } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';

const kSeconds = { click: 1.1 + 0.28, key: 0.28, notch: 0.28, decision: 1.35, glance: 0.23, hand: 0.4 };
const kClickNoisePx = 1.2;
const kDrawScale = 0.03; // metres a pixel, or finer, to draw at

// -- where

/** Spaces that print_spaces or make_lot printed, one a line. */
export const readSpaces = (file) =>
  readFileSync(file, 'utf8').trim().split('\n').map((line) => {
    const [x, y, heading, length, width, seen = 1] = line.split(' ').map(Number);
    return { x, y, heading, length, width, seen };
  });

/** A page of a server of its own, in a browser of its own; DRIVE is - where there is none. */
export async function withServer(program, map, drive, pageFolder, view, work) {
  const options = ['-m', map, ...(drive === '-' ? [] : ['--drive', drive]), '--port', '0', '--who', 'ann'];
  const server = spawn(program, ['label', ...options], { stdio: ['ignore', 'pipe', 'inherit'] });
  let said = '';
  server.stdout.on('data', (bytes) => (said += bytes));
  while (!said.includes('token=')) await new Promise((later) => setTimeout(later, 50));
  const { chromium } = createRequire(`${pageFolder}/`)('playwright-core');
  const browser = await chromium.launch({ executablePath: '/usr/bin/chromium', args: ['--no-sandbox', '--disable-gpu'] });
  try {
    const page = await (await browser.newContext(view)).newPage();
    await page.goto(said.match(/http:\S+/)[0]);
    await page.waitForFunction(() => document.querySelector('#status').textContent === 'All changes saved');
    await work(page);
  } finally {
    await browser.close();
    server.kill('SIGTERM');
  }
}

// -- reading the page

export const isAsked = async (me) => (await me.text('#subject')).startsWith('Is this');

const inside = (b, x, y) => {
  const [dx, dy, c, s] = [x - b.x, y - b.y, Math.cos(b.heading), Math.sin(b.heading)];
  return Math.abs(c * dx + s * dy) <= b.length / 2 && Math.abs(c * dy - s * dx) <= b.width / 2;
};
export const at = (b, l, w) => [
  b.x + Math.cos(b.heading) * l - Math.sin(b.heading) * w,
  b.y + Math.sin(b.heading) * l + Math.cos(b.heading) * w,
];
function overlap(a, b) {
  let both = 0;
  const n = 24;
  for (let i = 0; i < n; ++i)
    for (let k = 0; k < n; ++k)
      if (inside(b, ...at(a, ((i + 0.5) / n - 0.5) * a.length, ((k + 0.5) / n - 0.5) * a.width))) ++both;
  const area = (both / n / n) * a.length * a.width;
  return area / (a.length * a.width + b.length * b.width - area);
}
const near = (box, list) => list.filter((s) => Math.hypot(s.x - box.x, s.y - box.y) < 4);
export function best(box, list) {
  let found = { space: null, iou: 0 };
  for (const space of near(box, list)) {
    const iou = overlap(box, space);
    if (iou > found.iou) found = { space, iou };
  }
  return found;
}

// -- hands and eyes

function random(state) {
  let s = Number(state) * 2654435761 % 4294967296;
  const next = () => ((s = (s * 1664525 + 1013904223) % 4294967296) + 0.5) / 4294967296;
  return () => Math.sqrt(-2 * Math.log(next())) * Math.cos(2 * Math.PI * next());
}

export class Labeller {
  counts = { click: 0, key: 0, notch: 0, decision: 0, glance: 0, hand: 0 };
  waited = 0;
  hand = 'mouse';
  shots = 0;
  log = [];

  constructor(page, out, seed) {
    Object.assign(this, { page, out, gauss: random(seed) });
  }

  async rest(ms = 260) {
    await this.page.waitForTimeout(ms); // the map has come to rest; part of every action's own time
  }
  use(hand) {
    if (this.hand !== hand) ++this.counts.hand;
    this.hand = hand;
  }
  async key(name, times = 1) {
    this.use('keys');
    for (let i = 0; i < times; ++i) {
      ++this.counts.key;
      await this.page.keyboard.press(name);
    }
  }
  view() {
    return this.page.evaluate(() => {
      const element = document.querySelector('#map');
      const [cx, cy, resolution] = element.dataset.place.split(' ').map(Number);
      const { x, y, width, height } = element.getBoundingClientRect();
      return { cx, cy, resolution, x, y, width, height };
    });
  }
  async pixel([x, y]) {
    const v = await this.view();
    return [v.x + v.width / 2 + (x - v.cx) / v.resolution, v.y + v.height / 2 - (y - v.cy) / v.resolution];
  }
  async click(place) {
    this.use('mouse');
    ++this.counts.click;
    const [u, v] = (await this.pixel(place)).map((p) => p + kClickNoisePx * this.gauss());
    await this.page.mouse.move(u, v);
    await this.page.mouse.click(u, v);
  }
  /** Zooms in round a place with the wheel until it is large enough to draw. */
  async zoomTo(place) {
    let pointed = false;
    for (let i = 0; i < 12 && (await this.view()).resolution > kDrawScale; ++i) {
      this.use('mouse');
      const [u, v] = await this.pixel(place);
      if (!pointed) ++this.counts.click; // to point there; the buttonless part of a click
      pointed = true;
      await this.page.mouse.move(u, v);
      await this.page.mouse.wheel(0, -120);
      ++this.counts.notch;
      await this.rest(350);
    }
  }
  async inSight(box) {
    const v = await this.view();
    const [u, w] = await this.pixel([box.x, box.y]);
    const margin = 3 / v.resolution;
    return u > v.x + margin && u < v.x + v.width - margin && w > v.y + margin && w < v.y + v.height - margin;
  }
  async bring(box) {
    if (!(await this.inSight(box)) || (await this.view()).resolution > kDrawScale) {
      await this.key('0');
      await this.rest();
      await this.zoomTo([box.x, box.y]);
    }
  }
  decide(n = 1) {
    this.counts.decision += n;
  }
  glance(n) {
    this.counts.glance += n;
  }
  async text(id) {
    return (await this.page.textContent(id)) ?? '';
  }
  api(what) {
    return this.page.evaluate(async (name) => (await fetch(`api/${name}`)).json(), what);
  }
  async shot(name) {
    await this.rest(400);
    await this.page.screenshot({ path: join(this.out, `${String(++this.shots).padStart(2, '0')}_${name}.png`) });
  }
  async wait(condition, what, ms = 180000) {
    const begin = Date.now();
    while (!(await condition())) {
      if (Date.now() - begin > ms) throw new Error(`did not happen: ${what}`);
      await this.page.waitForTimeout(40);
    }
    this.waited += (Date.now() - begin) / 1000;
  }
  note(text) {
    this.log.push(text);
    console.log(text);
  }

  /** Seconds that a practised person takes for all that was done. */
  modelled() {
    return Object.entries(this.counts).reduce((sum, [name, n]) => sum + n * kSeconds[name], 0);
  }
}
