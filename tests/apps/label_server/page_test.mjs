// A labeller's work: draw three spaces, learn, accept and reject with keys, undo, reload; and a server
// that dies between two clicks. Every label that the page called stored is there, once.
import { check, clickPlace, labelsOf, stored, threeClicks, until, withPage } from './browser.mjs';

const near = (label, space, m) => Math.hypot(label.x - space[0], label.y - space[1]) < m;

async function draw(page, space) {
  const before = (await labelsOf(page)).length;
  for (const corner of threeClicks(space)) await clickPlace(page, ...corner);
  await until(async () => (await labelsOf(page)).length === before + 1, 'a drawn box is stored');
}

await withPage(async ({ page, spaces, server }) => {
  await page.keyboard.press('d');
  for (const i of [2, 7, 14]) await draw(page, spaces[i]);
  const drawn = await labelsOf(page);
  check([2, 7, 14].every((i, k) => near(drawn[k], spaces[i], 0.15)), 'boxes lie where they were clicked');
  check(drawn.every((l) => Math.abs(l.length - 5) < 0.2 && Math.abs(l.width - 2.5) < 0.2), 'with their sides');
  await until(async () => (await page.locator('#view-picture polygon').count()) === 2, 'the camera view shows the outline');
  await page.keyboard.press('d');

  await page.keyboard.press('t');
  await until(() => page.isEnabled('#accept'), 'a question comes by itself', 120000);
  const answers = { a: 0, r: 0 };
  for (let i = 0; i < 6; ++i) {
    const key = i % 3 === 2 ? 'a' : 'r';
    const before = (await labelsOf(page)).length;
    await until(async () => (await page.textContent('#subject')).includes('parking space?'), 'a question is open');
    await page.keyboard.press(key);
    await until(async () => (await labelsOf(page)).length === before + 1, `answer ${i + 1} is stored`);
    ++answers[key];
  }
  const answered = await labelsOf(page);
  check(answered.filter((l) => l.source === 'accepted').length === answers.a, 'accepted ones are labels');
  check(answered.filter((l) => l.kind === 'not_parking_space').length === answers.r, 'rejected ones are kept');

  await page.selectOption('#list-what', 'history');
  await until(async () => /create label \d+, no parking space/.test(await page.textContent('#rows')), 'the history tells what was rejected');
  await page.selectOption('#list-what', 'questions');
  await page.focus('#map');

  await page.keyboard.press('Control+z');
  await until(async () => (await labelsOf(page)).length === answered.length - 1, 'undo takes an answer back');
  await page.keyboard.press('Control+y');
  await until(async () => (await labelsOf(page)).length === answered.length, 'redo brings it again');

  await page.reload();
  await stored(page);
  const reloaded = await labelsOf(page);
  const counts = `labels${answered.length - answers.r}, 3 drawn`;
  await until(async () => (await page.textContent('#progress')).includes(counts), 'a reload shows the same labels');

  // The server dies with the first click of a box done; the box is finished without one.
  await page.keyboard.press('d');
  const [first, second, third] = threeClicks(spaces[19]);
  await clickPlace(page, ...first);
  await server.kill('SIGKILL');
  await clickPlace(page, ...second);
  await clickPlace(page, ...third);
  await until(async () => (await page.textContent('#status')).includes('not saved yet'), 'the page says so');
  await server.start();
  await until(async () => (await labelsOf(page)).length > answered.length, 'it is stored later');
  await until(async () => !(await page.textContent('#status')).includes('not saved'), 'nothing waits any more');
  const after = await labelsOf(page);
  check(after.length === answered.length + 1, 'every label is there once, the waiting one too');
  check(after.filter((l) => near(l, spaces[19], 0.15)).length === 1, 'where it was drawn');
  for (const label of reloaded)
    check(after.some((l) => l.id === label.id && l.version === label.version), `label ${label.id} as it was`);
  check((await server.kill('SIGTERM')) === 0, 'the server ends cleanly');
});
