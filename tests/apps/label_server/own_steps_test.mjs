// Undo and redo of steps that only the page knows (skips, and moves of a hypothesis before its
// answer), and of changes that had no effect.
import { check, labelsOf, stored, until, withPage } from './browser.mjs';
import { draw, hold, pause, quickly, select, showAll, status, teach } from './hands.mjs';

const near = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]) < 1e-6;

// Ground place of the hypothesis in question, from its camera view.
function watchPlace(page) {
  let last = null;
  page.on('request', (request) => {
    if (request.url().endsWith('api/view')) last = request.postDataJSON();
  });
  const known = () => last?.x !== undefined;
  return {
    known: () => until(known, 'the camera view of what is asked about'),
    at: ([x, y], what) => until(() => known() && near([last.x, last.y], [x, y]), what),
    now: () => [last.x, last.y],
  };
}

async function press(page, key, words) {
  await page.evaluate(() => (document.querySelector('#status').textContent = ''));
  await page.keyboard.press(key);
  await until(async () => (await status(page)).includes(words), `${key}: ${words}`);
}

async function movesAndSkips(page, place) {
  await place.known();
  const [x, y] = place.now();
  const labels = (await labelsOf(page)).length;
  await quickly(page, 'ArrowLeft', 3);
  await place.at([x - 0.15, y], 'keys move what is asked about');
  await pause(500);
  await quickly(page, 'ArrowUp', 2);
  await press(page, 'Control+z', 'Move undone');
  await place.at([x - 0.15, y], 'the last keys are taken back');
  await press(page, 'Control+z', 'Move undone');
  await place.at([x, y], 'and those before');
  await press(page, 'Control+y', 'Move redone');
  await press(page, 'Control+y', 'Move redone');
  await place.at([x - 0.15, y + 0.1], 'both are done again');
  check((await labelsOf(page)).length === labels, 'nothing stored is touched');

  await page.keyboard.press('s');
  await until(() => !near(place.now(), [x - 0.15, y + 0.1]), 'a skip goes on');
  await press(page, 'Control+z', 'Skip undone');
  await place.at([x - 0.15, y + 0.1], 'what was skipped is asked again, as keys have left it');
  await press(page, 'Control+y', 'Skip redone');
  await until(() => !near(place.now(), [x - 0.15, y + 0.1]), 'redo skips it');
  await press(page, 'Control+z', 'Skip undone');
  await place.at([x - 0.15, y + 0.1], 'once more');

  await page.keyboard.press('a');
  await until(async () => (await labelsOf(page)).length === labels + 1, 'it is accepted');
  const { x: u, y: v, sigma_m: exact } = (await labelsOf(page)).at(-1);
  check(near([u, v], [x - 0.15, y + 0.1]), 'where keys have put it');
  await until(() => !near(place.now(), [u, v]), 'the next one is asked');
  await press(page, 'Control+z', 'undone');
  await place.at([u, v], 'it is open again, as keys have left it');
  check((await labelsOf(page)).length === labels, 'and no label');
  await press(page, 'Control+z', 'Move undone');
  await place.at([x - 0.15, y], 'undo goes on with the keys before');
  await press(page, 'Control+y', 'Move redone');
  await press(page, 'Control+y', 'redone');
  await until(async () => (await labelsOf(page)).length === labels + 1, 'and redo goes all the way back');
  for (let i = 0; i < 3; ++i) await press(page, 'Control+z', i === 0 ? 'undone' : 'Move undone');
  await place.at([x, y], 'it is open again as it was found');
  await page.keyboard.press('a');
  await until(async () => (await labelsOf(page)).length === labels + 1, 'and accepted');
  const { sigma_m: found } = (await labelsOf(page)).at(-1);
  // In addition to the uncertainty of the pose: 3 cm if drawn, 12 cm if found.
  const apart = found ** 2 - exact ** 2;
  check(Math.abs(apart - (0.12 ** 2 - 0.03 ** 2)) < 0.002, `less exact than what keys have shaped: ${found}, ${exact}`);
}

// What waits behind a change that is refused was meant for it.
async function refusedChange(page, spaces) {
  await page.keyboard.press('Escape');
  await showAll(page);
  const [label] = await labelsOf(page);
  await select(page, label.id, spaces[0]);
  const refuse = (route) => route.fulfill({ status: 422, json: { error: 'width: no' } });
  const release = await hold(page, '**/api/labels/*', 'PUT', refuse);
  await page.keyboard.press(']');
  await page.keyboard.press('Control+z');
  await page.keyboard.press('Control+y');
  const before = await labelsOf(page);
  const words = [];
  await page.exposeFunction('hinted', (text) => words.push(text));
  await page.evaluate(() =>
    new MutationObserver(() => window.hinted(document.querySelector('#hint').textContent)).observe(
      document.querySelector('#hint'), { childList: true, characterData: true, subtree: true }),
  );
  await release();
  await until(() => words.some((text) => text.includes('the change was not saved')), 'the page says what it was for');
  await pause(300);
  check(words.some((text) => text.includes('width: no')), `with the reason: ${words}`);
  check(!words.some((text) => text.includes('another page')), 'and speaks of no other page');
  check(JSON.stringify(await labelsOf(page)) === JSON.stringify(before), 'nothing else was taken back');
  await page.keyboard.press('Control+z');
  await until(async () => (await labelsOf(page)).length === before.length - 1, 'the next undo is of what was stored before');
}

const bobChanges = async (page, id) => {
  const { version } = (await labelsOf(page)).find((label) => label.id === id);
  const status = await page.evaluate(async ([path, body]) => {
    const headers = { 'Content-Type': 'application/json' };
    return (await fetch(path, { method: 'PUT', headers, body: JSON.stringify(body) })).status;
  }, [`api/labels/${id}`, { version, who: 'bob', note: `narrow ${version}` }]);
  check(status === 200, `somebody else changes label ${id}`);
};

// Refused with those words; they go before the next key.
async function refused(page, key, words) {
  await page.evaluate(() => (document.querySelector('#hint').textContent = ''));
  await page.keyboard.press(key);
  await until(async () => (await page.textContent('#hint')).includes(words), `${key}: ${words}`);
}

// Changes of other users stay. The same key then continues with the step before.
async function passedOver(page, spaces) {
  await page.keyboard.press('Escape');
  await showAll(page);
  await page.keyboard.press('d');
  for (const i of [6, 8, 10, 12]) await draw(page, spaces[i]);
  await page.keyboard.press('d');
  const [first, second, third, fourth] = (await labelsOf(page)).slice(-4).map(({ id }) => id);
  const has = async (id) => (await labelsOf(page)).some((label) => label.id === id);
  await bobChanges(page, third);
  await bobChanges(page, fourth);
  await refused(page, 'Control+z', `bob has changed label ${fourth}`);
  await refused(page, 'Control+z', `bob has changed label ${third}`);
  await press(page, 'Control+z', `Label ${second}: change undone`);
  check(!(await has(second)) && (await has(third)) && (await has(fourth)), 'what was done before them is taken back, they stay');
  await press(page, 'Control+y', `Label ${second}: change redone`);
  check(await has(second), 'and brought again');

  // The page reports another user's change before it skips it.
  await bobChanges(page, second);
  await refused(page, 'Control+z', `bob has changed label ${second}`);
  await press(page, 'Control+z', `Label ${first}: change undone`);
  await press(page, 'Control+y', `Label ${first}: change redone`);

  // Several steps of one label stand together.
  await showAll(page);
  await page.keyboard.press('d');
  await draw(page, spaces[16]);
  await draw(page, spaces[18]);
  await page.keyboard.press('d');
  const [below, twice] = (await labelsOf(page)).slice(-2).map(({ id }) => id);
  await until(async () => (await page.textContent('#subject')).endsWith(` ${twice}`), 'what was drawn last is selected');
  await page.keyboard.press(']');
  await until(async () => (await labelsOf(page)).at(-1).version === 2, 'and changed by a key');
  await bobChanges(page, twice);
  await refused(page, 'Control+z', `bob has changed label ${twice}`);
  await press(page, 'Control+z', `Label ${below}: change undone`);
  await press(page, 'Control+y', `Label ${below}: change redone`);
  await press(page, 'Control+z', `Label ${below}: change undone`);
  await press(page, 'Control+y', `Label ${below}: change redone`);

  // Two keys at once: of the second, which waits behind the first, nothing comes.
  await showAll(page);
  await page.keyboard.press('d');
  await draw(page, spaces[14]);
  await page.keyboard.press('d');
  const last = (await labelsOf(page)).at(-1).id;
  await bobChanges(page, last);
  const release = await hold(page, '**/api/undo', 'POST');
  await page.keyboard.press('Control+z');
  await page.keyboard.press('Control+z');
  await release();
  await until(async () => (await page.textContent('#hint')).includes(`bob has changed label ${last}`), 'the first is refused');
  await pause(300);
  check((await page.textContent('#hint')).includes('bob has changed') && (await has(first)), 'and no word of another page');
  await press(page, 'Control+z', `Label ${below}: change undone`);
  await page.reload();
  await stored(page);
  await refused(page, 'Control+z', `bob has changed label ${last}`);
  check(await page.isHidden('#conflict'), 'there are no two versions to choose from');
}

await withPage(async ({ page, spaces, server }) => {
  const place = watchPlace(page);
  await teach(page, spaces.slice(0, 4));
  await movesAndSkips(page, place);
  await refusedChange(page, spaces);
  await passedOver(page, spaces);
  check((await server.kill('SIGTERM')) === 0, 'the server ends cleanly');
});
