// What goes wrong around a labeller: a full disk, a server that ends in the middle of a round or of an
// undo, text that looks like a page.
import { check, labelsOf, stored, until, withPage } from './browser.mjs';
import { clickCorners, draw, status } from './hands.mjs';

await withPage(async ({ page, spaces, server, browser }) => {
  await page.keyboard.press('d');
  for (const i of [2, 7, 14]) await draw(page, spaces[i]);

  // A full disk: the page says so and keeps the change that it could not store.
  // No file may grow beyond one page, so that no save finds room, whatever the map file has left over.
  server.limitFiles(4096);
  const fits = [];
  for (const i of [0, 1, 3, 4, 5, 6]) {
    await clickCorners(page, spaces[i]);
    fits.push(spaces[i]);
    await until(async () => /not saved yet|saved$/.test(await status(page)), 'the page says what came of it');
  }
  await until(async () => (await status(page)).includes('not saved yet'), 'a full disk is told');
  check(/full|room|disk/.test(await status(page)), `in words: ${await status(page)}`);
  server.limitFiles('unlimited');
  await until(async () => (await labelsOf(page)).length === 9, 'what waited is stored when there is room');
  check((await labelsOf(page)).length === 9, 'every label is there once');
  // What came too slowly is sent again.
  let slow = 1;
  await page.route('**/api/labels', (route) => (route.request().method() === 'POST' && slow-- > 0
    ? route.fulfill({ status: 408, body: JSON.stringify({ error: 'the request took longer than 5 s' }) }) : route.continue()));
  await clickCorners(page, spaces[8]);
  await until(async () => (await labelsOf(page)).length === 10, 'a label that a slow line held up is stored');
  check(slow === -1, 'it was sent twice');
  await page.unroute('**/api/labels');
  await page.keyboard.press('Control+z');
  await until(async () => (await labelsOf(page)).length === 9, 'and taken back');
  await page.keyboard.press('d');

  // A round of questions survives the server.
  await page.keyboard.press('Escape');
  await page.keyboard.press('t');
  await until(() => page.isEnabled('#reject'), 'a question comes by itself', 120000);
  const rounds = await page.textContent('#progress');
  const open = async () => page.evaluate(async () => (await (await fetch('api/hypotheses')).json()));
  const before = await open();
  check((await server.kill('SIGTERM')) === 0, 'the server ends cleanly');
  await server.start();
  await until(async () => (await status(page)) === 'All changes saved', 'the page finds the server again');
  const after = await open();
  check(before.hypotheses.length > 0 && JSON.stringify(before) === JSON.stringify(after), 'hypotheses and questions as before');
  await page.reload();
  await stored(page);
  // Labels, hypotheses and rounds come one after another.
  await until(async () => (await page.textContent('#progress')) === rounds, 'and the round, told in the same words');
  await page.keyboard.press('n');
  await until(async () => (await page.textContent('#subject')).includes('parking space?'), 'the next question is asked');

  // An undo that the server did not hear is sent again, and done once.
  await page.keyboard.press('Escape');
  await server.kill('SIGKILL');
  await page.keyboard.press('Control+z');
  await until(async () => (await status(page)).includes('not saved yet'), 'an undo waits for the server');
  await server.start();
  await until(async () => (await labelsOf(page)).length === 8, 'it is done when the server is back');
  await until(async () => /undone|All changes saved/.test(await status(page)), 'and told');
  await page.keyboard.press('Control+y');
  await until(async () => (await labelsOf(page)).length === 9, 'redo brings the label again');

  // A page too many waits for its turn.
  const page2 = await browser.newPage();
  await page2.goto(server.address);
  await stored(page2);
  let full = true;
  await page2.route('**/api/events', (route) => (full ? route.fulfill({ status: 503, body: '{}' }) : route.continue()));
  await page2.reload();
  await until(async () => (await status(page2)).includes('Too many pages'), 'a page too many says so');
  full = false;
  await stored(page2);
  await page2.close();

  // Words are words.
  const evil = '<img src=x onerror="document.title=1">';
  await page.click('#edit-classes');
  await page.click('#classes-add');
  await page.fill('#classes-table tr:last-child [name=kind]', 'bay');
  await page.fill('#classes-table tr:last-child [name=title]', evil);
  await page.fill('#classes-table tr:nth-child(1) [name=colour]', '#ff0000');
  await page.click('#classes-save');
  await until(async () => (await page.textContent('#classes')).includes(evil), 'a class appears as it was written');
  await page.selectOption('#list-what', 'labels');
  await page.click('#rows .line');
  await page.fill('#label-note', evil);
  await page.keyboard.press('Tab');
  await until(async () => (await page.textContent('#rows')).includes(evil), 'a note appears as it was written');
  check((await page.locator('#rows img, #classes img').count()) === 0, 'and is no part of the page');
  check((await page.title()) !== '1', 'nor a program');
  await page.reload();
  await stored(page);
  check((await page.textContent('#classes')).includes(evil), 'classes are in the map');
  check((await page.getAttribute('#classes circle', 'fill')).toLowerCase() === '#ff0000', 'with their colours');

  // A list of labels that comes late does not take away what was stored meanwhile.
  const count = (await labelsOf(page)).length;
  await page.route('**/api/labels', async (route) => {
    const response = await route.fetch();
    await new Promise((later) => setTimeout(later, 4000));
    await route.fulfill({ response });
  }, { times: 1 });
  const late = page.waitForResponse((response) => response.url().endsWith('api/labels') && response.request().method() === 'GET');
  await page.reload();
  await stored(page);
  await page.keyboard.press('d');
  await clickCorners(page, spaces[9]);
  await page.selectOption('#list-what', 'labels');
  const listed = async (n) => (await page.textContent('#list-count')).startsWith(`${n} `);
  await until(() => listed(1), 'a box drawn before the list has come is there alone', 3000);
  await late;
  await until(() => listed(count + 1), 'and stays with those of the list', 3000);
  check((await server.kill('SIGTERM')) === 0, 'the server ends cleanly');
});
