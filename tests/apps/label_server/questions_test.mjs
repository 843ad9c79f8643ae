// A question appears by itself after training, but not while the user is at work on a label.
import { check, clickPlace, labelsOf, until, withPage } from './browser.mjs';
import { draw, isAsked, subject } from './hands.mjs';

const says = async (page, words) => (await page.textContent('#status')).includes(words);

// Rounds end when the test ends them; messages of one round differ from those of the next.
async function holdRounds(page) {
  let letThrough = () => {};
  const held = new Promise((done) => (letThrough = done));
  await page.route('**/api/learn', async (route) => {
    await held;
    await route.continue();
  });
  return async () => {
    await page.evaluate(() => (document.querySelector('#status').textContent = ''));
    letThrough();
  };
}

// A user in a field works on the label, even if undo selected it.
async function fieldKeepsItsLabel(page) {
  const release = await holdRounds(page);
  await page.keyboard.press('t');
  await until(async () => (await subject(page)) === 'Nothing selected', 'learning, then a field');
  await page.keyboard.press('Control+z');
  await until(async () => (await page.textContent('#status')).includes('undone'), 'undo');
  await page.keyboard.press('Control+y');
  await until(async () => /^(no )?parking space \d/i.test(await subject(page)), 'what came back is shown again');
  const shown = await subject(page);
  await page.focus('#label-note');
  await page.keyboard.type('narrow');
  await release();
  await until(() => says(page, 'next question is ready'), 'it waits for the field', 120000);
  check((await subject(page)) === shown, 'the label stays');
  await page.keyboard.press('Tab');
  await until(async () => (await labelsOf(page)).some((l) => l.note === 'narrow'), 'its note is stored');
  await page.keyboard.press('Escape');
  await page.focus('#map');
  await page.keyboard.press('Escape');
  await until(() => isAsked(page), 'then the question comes');
}

// The user left a question and selected it again: after the answer, the page moves to no other
// question.
async function chosenAgainByHand(page) {
  const asked = await page.getAttribute('#rows', 'aria-activedescendant');
  await page.keyboard.press('Escape');
  await until(async () => (await subject(page)) === 'Nothing selected', 'let go');
  await page.selectOption('#list-what', 'questions');
  await page.selectOption('#list-order', 'telling');
  await page.click(`#${asked}`);
  await until(() => isAsked(page), 'chosen in the list');
  await page.focus('#map');
  const before = (await labelsOf(page)).length;
  await page.keyboard.press('r');
  await until(async () => (await labelsOf(page)).length === before + 1, 'answered');
  await page.waitForTimeout(300);
  check((await subject(page)) === 'Nothing selected', 'nobody is sent on to the next');
}

// A round that could not start brings no question when the round of another user ends.
async function refusedRoundIsForgotten(page) {
  await page.route('**/api/learn', (route) => route.fulfill({ status: 422, json: { error: 'no round today' } }));
  await page.keyboard.press('t');
  await until(async () => (await page.textContent('#hint')).includes('no round today'), 'a round is refused');
  await page.unroute('**/api/learn');
  await page.evaluate(() =>
    fetch('api/learn', { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: '{"kind": "parking_space"}' }),
  );
  await until(() => says(page, ' likely'), 'somebody else\'s ends', 120000);
  await page.waitForTimeout(300);
  check((await subject(page)) === 'Nothing selected', 'and brings no question here');
}

await withPage(async ({ page, spaces, server }) => {
  await page.keyboard.press('d');
  for (const space of spaces.slice(0, 4)) await draw(page, space);
  await page.keyboard.press('d');

  // A slow undo step: its label is selected after `t` was pressed.
  await page.keyboard.press('Control+z');
  await until(async () => (await labelsOf(page)).length === 3, 'undo');
  await until(async () => (await page.textContent('#status')).includes('undone'), 'the page says so');
  await page.route('**/api/progress', async (route) => {
    await new Promise((later) => setTimeout(later, 700));
    await route.continue();
  });
  await page.keyboard.press('Control+y');
  await page.keyboard.press('t');
  await until(() => isAsked(page), 'a question comes after a redo that ended late', 120000);
  check((await labelsOf(page)).length === 4, 'the redo is done');
  await page.unroute('**/api/progress');

  // A step while the detector learns is shown, and does not hold the question back.
  let release = await holdRounds(page);
  await page.keyboard.press('t');
  await until(async () => (await subject(page)) === 'Nothing selected', 'learning');
  await page.keyboard.press('Control+z');
  await until(async () => (await labelsOf(page)).length === 3, 'undo meanwhile');
  await page.keyboard.press('Control+y');
  await until(async () => /^parking space \d/i.test(await subject(page)), 'what came back is shown');
  await release();
  await until(() => isAsked(page), 'the question comes all the same', 120000);

  // The user's selection stays. The question appears when the user clears the selection.
  release = await holdRounds(page);
  await page.keyboard.press('t');
  await until(async () => (await subject(page)) === 'Nothing selected', 'learning again');
  await page.keyboard.press('0');
  await page.waitForTimeout(400);
  const [x, y] = spaces[1];
  await clickPlace(page, x, y);
  await until(async () => /^parking space \d/i.test(await subject(page)), 'a label is chosen');
  const chosen = await subject(page);
  await release();
  await until(() => says(page, 'next question is ready'), 'the page says that a question waits', 120000);
  check((await subject(page)) === chosen, 'what was chosen is still selected');
  await page.keyboard.press('ArrowLeft');
  await page.keyboard.press('Escape');
  await until(() => isAsked(page), 'Esc brings it');
  await page.keyboard.press('Escape');
  await until(async () => (await subject(page)) === 'Nothing selected', 'Esc once more: it does not come again');
  await page.keyboard.press('n');
  await until(() => isAsked(page), 'but for n');

  // A half-drawn shape delays the question until Esc. A selection delays it until `N` or `A`.
  release = await holdRounds(page);
  await page.keyboard.press('t');
  await until(async () => (await subject(page)) === 'Nothing selected', 'learning once more');
  await page.keyboard.press('d');
  await page.keyboard.press(' ');
  await release();
  await until(() => says(page, 'next question is ready'), 'it waits for the shape', 120000);
  await page.keyboard.press('Escape');
  await until(() => isAsked(page), 'Esc, which clears the shape, brings it');
  await page.keyboard.press('d');
  for (const key of ['N', 'A']) {
    release = await holdRounds(page);
    await page.keyboard.press('t');
    await until(async () => (await subject(page)) === 'Nothing selected', `learning, then ${key}`);
    await page.keyboard.press('0');
    await page.waitForTimeout(400);
    await clickPlace(page, x, y);
    await until(async () => /^parking space \d/i.test(await subject(page)), 'a label is chosen again');
    await release();
    await until(() => says(page, 'next question is ready'), 'it waits again', 120000);
    await page.keyboard.press(key);
    const comes = async () => (await isAsked(page)) || (await says(page, 'No questions left'));
    await until(comes, `${key} brings it`);
  }
  await fieldKeepsItsLabel(page);
  await chosenAgainByHand(page);
  await refusedRoundIsForgotten(page);
  check((await server.kill('SIGTERM')) === 0, 'the server ends cleanly');
});
