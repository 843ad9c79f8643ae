// Keys that go on while a change is on its way, or while the server is away: what is stored in the end
// is what is shown, and nobody meets a change of his own as somebody else's.
import { check, clickPlace, labelsOf, threeClicks, until, withPage } from './browser.mjs';

const pause = (ms) => new Promise((later) => setTimeout(later, ms));
const shownWidth = async (page) => Number(await page.inputValue('#label-width'));
const storedWidth = async (page) => (await labelsOf(page))[0].width;
const same = (a, b) => Math.abs(a - b) < 0.006; // the field shows centimetres

// Each a change of its own: they are further apart than the quiet after which one is sent.
async function widen(page, times) {
  for (let i = 0; i < times; ++i) {
    await page.keyboard.press(']');
    await pause(400);
  }
}

await withPage(async ({ page, spaces, server }) => {
  await page.keyboard.press('d');
  for (const corner of threeClicks(spaces[4])) await clickPlace(page, ...corner);
  await until(async () => (await labelsOf(page)).length === 1, 'a drawn box is stored');
  await page.keyboard.press('d');
  await until(async () => (await shownWidth(page)) > 0, 'it is selected');

  // The server is slow: replies come while keys go on.
  const [drawn] = await labelsOf(page);
  let sent = 0;
  await page.route('**/api/labels/*', async (route) => {
    ++sent;
    await pause(650);
    await route.continue();
  });
  await widen(page, 8);
  await until(async () => same(await storedWidth(page), drawn.width + 0.4), 'all eight keys are stored');
  await pause(800);
  check(same(await shownWidth(page), await storedWidth(page)), 'what is shown is what is stored');
  check(sent > 1, 'by more than one change');
  check((await page.locator('#conflict[open]').count()) === 0, 'no change met another as somebody else\'s');
  await page.unroute('**/api/labels/*');

  // The server is away while two changes are made.
  await server.kill('SIGKILL');
  await widen(page, 2);
  await until(async () => (await page.textContent('#status')).includes('2 not stored yet'), 'two wait');
  await server.start();
  await until(async () => same(await storedWidth(page).catch(() => 0), drawn.width + 0.5), 'both are stored later');
  await until(async () => !(await page.textContent('#status')).includes('not stored'), 'nothing waits any more');
  check((await page.locator('#conflict[open]').count()) === 0, 'the second is no conflict with the first');
  check(same(await shownWidth(page), await storedWidth(page)), 'what is shown is what is stored, again');

  // Somebody else's change in between is told, not written over.
  const [now] = await labelsOf(page);
  let release = () => {};
  const held = new Promise((done) => (release = done));
  await page.route('**/api/labels/*', async (route) => {
    if (!route.request().postData().includes('"bob"')) await held;
    await route.continue();
  });
  await page.keyboard.press(']');
  await page.evaluate(async (label) => {
    const { id, kind, source, score, shape, x, y, heading, length, width, version } = label;
    const body = { kind, source, score, shape, x, y, heading, length, width, version, note: 'seen', who: 'bob', request: 'b1' };
    const headers = { 'Content-Type': 'application/json' };
    await fetch(`api/labels/${id}`, { method: 'PUT', headers, body: JSON.stringify(body) });
  }, now);
  release();
  await until(async () => (await page.locator('#conflict[open]').count()) === 1, 'a conflict with bob is told');
  check((await labelsOf(page))[0].note === 'seen', 'what bob stored stands until somebody decides');
  await page.click('#conflict-mine');
  await until(async () => same(await storedWidth(page), now.width + 0.05), 'the choice is stored');
  check((await server.kill('SIGTERM')) === 0, 'the server ends cleanly');
});
