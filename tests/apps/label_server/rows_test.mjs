// A row from its two ends. Labels that are accepted together overlap no existing label. The view of
// a user who looks around does not jump.
import { check, clickPlace, labelsOf, stored, until, withPage } from './browser.mjs';
import { draw, hold, subject } from './hands.mjs';

const near = (label, space) => Math.hypot(label.x - space[0], label.y - space[1]) < 0.15;
const place = (page) => page.getAttribute('#map', 'data-place');

await withPage(async ({ page, spaces, server }) => {
  // One side of the aisle: ten spaces, looking south.
  await page.keyboard.press('d');
  await draw(page, spaces[0]);
  await page.keyboard.press('b');
  await until(async () => (await page.textContent('#hint')).includes('select one end'), 'one end is not enough');
  const [x, y, heading, ...sides] = spaces[8];
  await draw(page, [x, y, heading + Math.PI, ...sides]); // drawn from its other end
  await page.keyboard.press('b');
  await until(async () => (await labelsOf(page)).length === 9, 'the row is filled');
  const row = await labelsOf(page);
  check(spaces.slice(0, 9).every((s) => row.filter((l) => near(l, s)).length === 1), 'each space once, where it is');
  await page.keyboard.press('b');
  await until(async () => (await page.textContent('#hint')).includes('no box is missing'), 'once is enough');
  await page.keyboard.press('p');
  await until(async () => (await labelsOf(page)).length === 10, 'one more');
  check((await labelsOf(page)).filter((l) => near(l, spaces[9])).length === 1, 'beyond the end');
  await page.keyboard.press('Control+z');
  await page.keyboard.press('Control+z');
  await until(async () => (await labelsOf(page)).length === 2, 'undo takes the row back as one step');
  await page.keyboard.press('Control+y');
  await until(async () => (await labelsOf(page)).length === 9, 'redo brings it again');
  await page.keyboard.press('d');

  // Learning that is asked for while a row is being filled comes after what that selects in the end.
  await page.keyboard.press('Control+z');
  await until(async () => (await labelsOf(page)).length === 2, 'the two ends again');
  for (const i of [0, 8]) {
    await page.keyboard.press('0');
    await page.waitForTimeout(400);
    await clickPlace(page, spaces[i][0], spaces[i][1]);
    await until(async () => /^parking space \d/i.test(await subject(page)), 'an end is chosen');
  }
  await page.route('**/api/hypotheses', async (route) => {
    await new Promise((later) => setTimeout(later, 700));
    await route.continue();
  });
  await page.keyboard.press('b');
  await page.keyboard.press('t');
  await until(() => page.isEnabled('#reject'), 'a question comes by itself', 120000);
  await page.unroute('**/api/hypotheses');
  check((await labelsOf(page)).length === 9, 'and the row is filled');
  const hypotheses = async () => (await page.evaluate(async () => (await fetch('api/hypotheses')).json())).hypotheses;
  await page.keyboard.press('0');
  await page.waitForTimeout(400);
  const other = (await hypotheses()).find((h) => h.probability > 0.5);
  await page.keyboard.press('Escape');
  const before = await place(page);
  await clickPlace(page, other.x, other.y);
  await until(async () => (await subject(page)).startsWith('Is this'), 'one that was not asked about');
  await page.keyboard.press('a');
  await until(async () => (await labelsOf(page)).length === 10, 'is answered');
  await page.waitForTimeout(400);
  check((await place(page)) === before, 'and the map stays where it is');
  await page.keyboard.press('n');
  await until(async () => (await place(page)) !== before, 'n goes to the next question');

  // A key that is held answers one question.
  const answered = (await labelsOf(page)).length;
  await page.keyboard.down('a');
  await page.keyboard.down('a');
  await page.keyboard.up('a');
  await until(async () => (await labelsOf(page)).length === answered + 1, 'a held key answers');
  await page.waitForTimeout(600);
  check((await labelsOf(page)).length === answered + 1, 'one question alone');

  // A box drawn a third over one that is likely, which would lie on it.
  await page.keyboard.press('0');
  await page.waitForTimeout(400);
  await page.keyboard.press('Escape');
  const left = (await hypotheses()).filter((h) => h.probability > 0.5);
  const [a] = left;
  await page.keyboard.press('d');
  await draw(page, [a.x + 1.6, a.y, a.heading, a.length, a.width]);
  await page.keyboard.press('d');
  await page.keyboard.press('Escape');
  const count = (await labelsOf(page)).length;
  // Pressed again before they are stored, too.
  const release = await hold(page, '**/api/labels', 'POST');
  await page.keyboard.press('Shift+A');
  await page.keyboard.press('Shift+A');
  await release();
  await until(async () => (await labelsOf(page)).length > count, 'the others are accepted');
  await until(async () => (await page.textContent('#status')).includes('overlap other'), 'the page says what it left');
  await page.waitForTimeout(400);
  const all = (await labelsOf(page)).filter((l) => l.kind === 'parking_space');
  const twice = all.filter((l, i) => all.some((o, j) => j < i && Math.hypot(l.x - o.x, l.y - o.y) < 0.5));
  check(twice.length === 0, 'nothing is stored twice');
  const onTop = all.filter((l) => Math.hypot(l.x - a.x, l.y - a.y) < 0.5);
  check(onTop.length === 0, 'what lies on a label is not stored');
  await page.reload();
  await stored(page);
  check((await server.kill('SIGTERM')) === 0, 'the server ends cleanly');
});
