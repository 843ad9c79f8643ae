// Takes the pictures of the page in docs/images; run by hand:
//   node pictures.mjs question|rows|people ROADBOOK MAP DRIVE SPACES LABEL_UI_FOLDER OUT.jpg
// The program labels MAP (use a copy). DRIVE is - if there is none. `question`: draws three of
// SPACES (print_spaces), trains, and waits for the next question. `rows`: all SPACES have labels,
// dark page. `people`: MAP holds examples of people (people_labeller.py), SPACES is -.
import { statSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { Labeller, at, best, isAsked, readSpaces, withServer } from './labeller.mjs';

const [what, program, map, drive, spacesFile, pageFolder, out] = process.argv.slice(2);
const kLargest = 200e3; // bytes

const spaces = spacesFile === '-' ? [] : readSpaces(spacesFile);

async function question(me) {
  await me.key('d');
  for (const part of [0.1, 0.5, 0.9]) {
    const space = spaces[Math.floor(part * spaces.length)];
    await me.bring(space);
    const before = (await me.api('labels')).labels.length;
    const [l, w] = [space.length / 2, space.width / 2];
    for (const place of [at(space, -l, -w), at(space, l, -w), at(space, 0, w)]) await me.click(place);
    await me.wait(async () => (await me.api('labels')).labels.length === before + 1, 'a box is stored', 20000);
  }
  await me.key('d');
  await me.key('t');
  await me.wait(() => isAsked(me), 'a question');
  await me.rest();
  const found = (await me.api('hypotheses')).hypotheses.filter((h) => best(h, spaces).iou > 0.7);
  await me.key('0');
  await me.rest(600);
  await me.click([found[0].x, found[0].y]);
  await me.key('f');
  await me.wait(async () => (await me.page.locator('#view-picture polygon').count()) > 0, 'the camera view', 20000);
}

async function rows(me) {
  await me.page.evaluate(async (list) => {
    const labels = list.map((space) => ({ ...space, shape: 'box', kind: 'parking_space', source: 'drawn', note: '' }));
    const headers = { 'Content-Type': 'application/json' };
    await fetch('api/labels', { method: 'POST', headers, body: JSON.stringify({ who: 'ann', request: 'rows', labels }) });
  }, spaces);
  await me.wait(async () => (await me.text('#progress')).includes(`labels${spaces.length},`), 'every space has its label', 20000);
  await me.page.selectOption('#list-what', 'labels');
  await me.page.selectOption('#list-order', 'number');
  await me.key('0');
  await me.rest(600);
  const { x, y } = spaces[Math.floor(spaces.length / 3)];
  await me.click([x, y]);
  await me.wait(async () => (await me.page.locator('#view-picture polygon').count()) > 0, 'the camera view', 20000);
}

// An image with one detected person; other hypotheses in it are rejected.
async function people(me) {
  if (await me.page.isVisible('#ground-side')) await me.key('m'); // a map without an overhead image begins here
  const likely = () => me.page.locator('#people-list button', { hasText: /person\? ([5-9]\d|100) %/ }).count();
  for (let i = 0; i < 24 && (await likely()) < 2; ++i) {
    const before = await me.page.getAttribute('#people-picture', 'data-image');
    await me.key('n');
    await me.wait(async () => (await me.page.getAttribute('#people-picture', 'data-image')) !== before, 'the next image', 60000);
    await me.rest();
  }
  const unlikely = me.page.locator('#people-list button', { hasText: /person\? [1-4]?\d %/ });
  for (let i = 0; i < 2 && (await unlikely.count()) > 0; ++i) {
    await unlikely.first().click();
    await me.key('r');
    await me.rest(500);
  }
}

const view = { viewport: { width: 1400, height: 900 }, colorScheme: what === 'rows' ? 'dark' : 'light' };
await withServer(program, map, drive, pageFolder, view, async (page) => {
  const me = new Labeller(page, tmpdir(), 1);
  await { question, rows, people }[what](me);
  await page.mouse.move(5, 895);
  await me.rest(1500);
  for (let quality = 85; quality > 20; quality -= 5) {
    await page.screenshot({ path: out, type: 'jpeg', quality });
    if (statSync(out).size < kLargest) break;
  }
});
