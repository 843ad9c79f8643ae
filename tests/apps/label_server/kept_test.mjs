// Two things must not be lost on the way to the server: a change that the server fails to store,
// and a conflict that the user has not decided when the page is loaded again. Two further ways
// reach functions that have no key.
import { check, labelsOf, stored, until, withPage } from './browser.mjs';
import { clickCorners, draw, hold, pause, select, showAll, status } from './hands.mjs';

const send = (page, method, path, body) =>
  page.evaluate(
    async ([m, to, json]) => {
      const headers = { 'Content-Type': 'application/json' };
      return (await fetch(to, { method: m, headers, body: JSON.stringify(json) })).status;
    },
    [method, path, body],
  );

// A browser without room for what waits: it is sent all the same.
async function noRoomToKeep(page, space) {
  await page.evaluate(() => {
    Storage.prototype.itsOwn = Storage.prototype.setItem;
    Storage.prototype.setItem = () => {
      throw new DOMException('full', 'QuotaExceededError');
    };
  });
  const release = await hold(page, '**/api/labels', 'POST');
  const before = (await labelsOf(page)).length;
  await clickCorners(page, space);
  await until(async () => (await status(page)).includes('storage is full'), 'the page says that nothing is kept');
  await release();
  await until(async () => (await labelsOf(page)).length === before + 1, 'a box is stored without it');
  await page.evaluate(() => (Storage.prototype.setItem = Storage.prototype.itsOwn));
}

await withPage(async ({ page, spaces, server }) => {
  await page.keyboard.press('d');
  await noRoomToKeep(page, spaces[0]);

  // The server fails to store one change. Later changes are stored, and the failed one is there
  // after a reload.
  let faults = 0;
  await page.route('**/api/labels', async (route) => {
    const body = route.request().postDataJSON();
    if (!body || Math.hypot(body.x - spaces[2][0], body.y - spaces[2][1]) > 0.5) return route.continue();
    ++faults;
    return route.fulfill({ status: 500, json: { error: 'no memory' } });
  });
  await clickCorners(page, spaces[2]);
  await clickCorners(page, spaces[4]);
  await until(async () => (await status(page)).includes('no memory'), 'the page says what is wrong');
  await until(() => page.isVisible('#left'), 'and after some tries that it is put aside');
  check((await page.textContent('#left')).includes('1 change could not be saved: no memory'), await page.textContent('#left'));
  check(faults === 3, `after three tries: ${faults}`);
  await until(async () => (await labelsOf(page)).length === 2, 'what was done after it is stored');
  await page.click('#left button:text("Send")');
  await until(() => faults === 6, 'sent again it fails again');
  await until(() => page.isVisible('#left'), 'and is told again');
  check((await page.locator('#left li').count()) === 1, 'once');
  await page.unroute('**/api/labels');
  await page.reload();
  await stored(page);
  await until(async () => (await labelsOf(page)).length === 3, 'a reload sends it');
  check((await page.isHidden('#left')) && (await labelsOf(page)).length === 3, 'once');

  // A conflict that was not decided is asked about again after a reload.
  await showAll(page);
  await select(page, 1, spaces[0]);
  const release = await hold(page, '**/api/labels/1', 'PUT');
  await page.fill('#label-note', 'mine');
  await page.keyboard.press('Tab');
  await pause(100);
  check((await send(await page.context().newPage().then(async (p) => (await p.goto(server.address), p)), 'PUT', 'api/labels/1', { who: 'bob', version: 1, note: 'theirs', request: 'b' })) === 200, 'bob is faster');
  await release();
  await until(() => page.isVisible('#conflict'), 'a conflict is told');
  await page.reload();
  await until(() => page.isVisible('#conflict'), 'and told again after a reload');
  check((await page.textContent('#conflict-table')).includes('theirs') && (await page.textContent('#conflict-table')).includes('mine'), 'with both versions');
  await page.click('#conflict-mine');
  await until(async () => (await labelsOf(page))[0].note === 'mine', 'and decided');
  await page.reload();
  await stored(page);
  await pause(500);
  check(await page.isHidden('#conflict'), 'it is decided once');

  // More classes than digits.
  const { classes, version } = await page.evaluate(async () => (await (await fetch('api/start')).json()).classes);
  const more = [...Array(9).keys()].map((i) => ({ kind: `more_${i}`, title: `more ${i}`, colour: '#112233', shape: 'box' }));
  check((await send(page, 'PUT', 'api/classes', { who: 'ann', version, classes: [...classes, ...more] })) === 200, 'eleven classes');
  await until(async () => (await page.locator('#classes input').count()) === 11, 'are shown');
  const chosen = () => page.evaluate(() => document.querySelector('#classes input:checked').value);
  await page.focus('#map');
  await page.keyboard.press('9');
  for (const key of ['.', '.', '.']) await page.keyboard.press(key);
  await until(async () => (await chosen()) === classes[0].kind, 'the one after the last is the first');
  await page.keyboard.press(',');
  await until(async () => (await chosen()) === 'more_8', 'and the one before it the last');
  check((await page.locator('#classes kbd').count()) === 9, 'digits are told of nine');

  // Who did what, by keys.
  await page.selectOption('#list-what', 'history');
  await until(async () => (await page.textContent('#rows')).includes('create label 1,'), 'the history is there');
  const at = () => page.getAttribute('#rows', 'aria-activedescendant');
  await page.focus('#rows');
  await page.keyboard.press('End');
  check((await at()) === 'row-e1', `the last row: ${await at()}`);
  await until(async () => (await page.textContent('#subject')).endsWith(' 1'), 'what it is about is selected');
  await page.keyboard.press('ArrowUp');
  check((await at()) === 'row-e2', `and up from there: ${await at()}`);
  check((await server.kill('SIGTERM')) === 0, 'the server ends cleanly');
});
