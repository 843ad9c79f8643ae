// What was answered is not asked again: not by a list of open hypotheses that was on its way meanwhile,
// nor after a reload where the answer still waits to be stored.
import { statSync } from 'node:fs';
import { check, labelsOf, stored, until, withPage } from './browser.mjs';
import { hypothesesOf, isAsked, pause, status, teach } from './hands.mjs';

const counted = async (page) => Number.parseInt(await page.textContent('#list-count'), 10);
const apart = ({ x, y }, other) => Math.hypot(x - other.x, y - other.y);

// Each place that a label answers is answered once.
function checkNoneTwice(labels) {
  const twice = labels.filter((a, i) => labels.slice(0, i).some((b) => apart(a, b) < 0.5));
  check(twice.length === 0, `no place has two labels: ${JSON.stringify(twice.map(({ id }) => id))}`);
}

async function staleList(page, spaces) {
  await page.selectOption('#list-what', 'questions');
  await page.focus('#map');
  let release = () => {};
  const held = new Promise((done) => (release = done));
  await page.route('**/api/hypotheses', async (route) => {
    const response = await route.fetch();
    await held;
    await route.fulfill({ response });
  }, { times: 1 });
  const asked = page.waitForResponse('**/api/hypotheses');
  const fetched = page.waitForRequest('**/api/hypotheses');
  await page.evaluate(async ([x, y, heading, length, width]) => {
    const headers = { 'Content-Type': 'application/json' };
    const box = { x: x + 8, y: y + 8, heading, length, width, shape: 'box', kind: 'parking_space', source: 'drawn', score: 1, note: '', who: 'bob', request: 'late' };
    await fetch('api/labels', { method: 'POST', headers, body: JSON.stringify(box) });
  }, spaces.at(-1));
  await fetched;
  await pause(300); // its answer is made
  const before = await counted(page);
  const labels = (await labelsOf(page)).length;
  await page.keyboard.press('a');
  await until(async () => (await labelsOf(page)).length === labels + 1, 'an answer is stored');
  release();
  await asked;
  await pause(300);
  check((await counted(page)) < before, `what was answered is no hypothesis any more: ${before}, ${await counted(page)}`);
}

async function answersThatWait(page, server) {
  await until(() => isAsked(page), 'something is asked');
  server.limitFiles(statSync(server.map).size);
  const open = (await hypothesesOf(page)).hypotheses.length;
  for (let i = 0; i < 3; ++i) {
    await page.keyboard.press('a');
    await pause(200);
  }
  await until(async () => (await status(page)).includes('not saved yet'), 'a full disk holds answers up');
  await page.reload();
  await page.selectOption('#list-what', 'questions');
  await page.focus('#map');
  await until(async () => (await counted(page)) > 0, 'hypotheses are there again');
  check((await counted(page)) <= open - 3, `but for the three that wait: ${open}, ${await counted(page)}`);
  for (let i = 0; i < 2; ++i) {
    await page.keyboard.press('n');
    await until(() => isAsked(page), 'the next one is asked');
    await page.keyboard.press('a');
    await pause(200);
  }
  server.limitFiles('unlimited');
  await stored(page);
}

await withPage(async ({ page, spaces, server }) => {
  await teach(page, spaces.slice(0, 4));
  await staleList(page, spaces);
  await answersThatWait(page, server);
  checkNoneTwice((await labelsOf(page)).filter(({ kind }) => kind === 'parking_space'));
  check((await server.kill('SIGTERM')) === 0, 'the server ends cleanly');
});
