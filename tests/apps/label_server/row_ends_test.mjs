// A selection stays: a row's end that keys moved, and a label that the user selected while a row, a
// drawn box or a confirmation was being sent.
import { check, clickPlace, labelsOf, stored, until, withPage } from './browser.mjs';
import { clickCorners, draw, hold, pause, select, showAll, subject } from './hands.mjs';

const near = (label, space) => Math.hypot(label.x - space[0], label.y - space[1]) < 0.15;
const versionOf = async (page, id) => (await labelsOf(page)).find((label) => label.id === id).version;

// A label that keys have moved is where it was moved to, whatever was done since.
async function keysThenClicks(page, spaces) {
  await page.keyboard.press('ArrowUp');
  await page.keyboard.press('b');
  await until(async () => (await labelsOf(page)).length === 9, 'a row is filled from an end that keys have moved');
  await page.keyboard.press('Control+z');
  await until(async () => (await labelsOf(page)).length === 2, 'and taken back');
  await until(async () => (await subject(page)) === 'Nothing selected', 'nothing is selected then');
  await showAll(page);
  await select(page, 2, spaces[8]);

  await page.keyboard.press('ArrowLeft');
  await until(async () => (await versionOf(page, 2)) === 3, 'another key is stored');
  await pause(200);
  await clickPlace(page, spaces[8][0], spaces[8][1]);
  await pause(700);
  check((await subject(page)).endsWith(' 2'), 'a click on what is selected leaves it so');
  check((await versionOf(page, 2)) === 3, 'and stores nothing');
}

// The ends of a row are those selected when the user asked for the row; a later selection stays.
async function choosingMeanwhile(page, spaces) {
  await page.keyboard.press('d');
  await draw(page, spaces[14]);
  await page.keyboard.press('d');
  await showAll(page);
  await select(page, 1, spaces[0]);
  await select(page, 2, spaces[8]);
  const other = (await labelsOf(page)).at(-1).id;
  let release = await hold(page, '**/api/labels', 'POST');
  await page.keyboard.press('b');
  await pause(200);
  await select(page, other, spaces[14]);
  await release();
  await until(async () => (await labelsOf(page)).length === 10, 'the row is stored');
  await pause(400);
  check((await subject(page)).endsWith(` ${other}`), 'what was chosen meanwhile is still selected');
  await page.keyboard.press('Control+z');
  await until(async () => (await labelsOf(page)).length === 3, 'the row is taken back');

  // A drawn box is an end while it is on its way, too.
  await showAll(page);
  await select(page, 1, spaces[0]);
  release = await hold(page, '**/api/labels', 'POST');
  await page.keyboard.press('d');
  await clickCorners(page, spaces[4]);
  await page.keyboard.press('b');
  await page.keyboard.press('d');
  await select(page, other, spaces[14]);
  await release();
  await until(async () => (await labelsOf(page)).length === 7, 'a box and the row up to it are stored');
  const labels = await labelsOf(page);
  check(spaces.slice(0, 5).every((s) => labels.filter((l) => near(l, s)).length === 1), 'each space once');
  await pause(400);
  check((await subject(page)).endsWith(` ${other}`), 'again what was chosen meanwhile is selected');

  // A second `p` continues from the result of the first, stored or not.
  for (const i of [3, 4]) await select(page, labels.find((l) => near(l, spaces[i])).id, spaces[i]);
  release = await hold(page, '**/api/labels', 'POST');
  await page.keyboard.press('p');
  await page.keyboard.press('p');
  await release();
  await until(async () => (await labelsOf(page)).length === 9, 'two more are stored');
  const [one, two] = (await labelsOf(page)).slice(-2);
  check(near(one, spaces[5]) && near(two, spaces[6]), 'one after the other');
}

// Labels that have moved with the map are confirmed one after another.
async function confirming(page, spaces) {
  await page.route('**/api/labels', async (route) => {
    if (route.request().method() !== 'GET') return route.fallback();
    const response = await route.fetch();
    const { labels } = await response.json();
    for (const label of labels) if (label.id <= 2 && label.version <= 3) label.moved_m = 0.5;
    await route.fulfill({ response, json: { labels } });
  });
  await page.reload();
  await stored(page);
  await until(async () => (await page.textContent('#progress')).includes('2 moved farther'), 'two have moved');
  await showAll(page);
  await select(page, 1, spaces[0]);
  const release = await hold(page, '**/api/labels/*', 'PUT');
  await page.keyboard.press('a');
  await until(async () => (await subject(page)).endsWith(' 2'), 'the next one comes at once');
  await pause(400);
  await showAll(page);
  const other = (await labelsOf(page)).find((label) => near(label, spaces[14])).id;
  await select(page, other, spaces[14]);
  await release();
  await until(async () => (await page.textContent('#progress')).includes('1 moved farther'), 'the first is confirmed');
  await pause(300);
  check((await subject(page)).endsWith(` ${other}`), 'and what was chosen meanwhile stays');
  await page.unroute('**/api/labels');
}

await withPage(async ({ page, spaces, server }) => {
  await page.keyboard.press('d');
  await draw(page, spaces[0]);
  await draw(page, spaces[8]);
  await page.keyboard.press('d');
  await keysThenClicks(page, spaces);
  await choosingMeanwhile(page, spaces);
  await confirming(page, spaces);
  check((await server.kill('SIGTERM')) === 0, 'the server ends cleanly');
});
