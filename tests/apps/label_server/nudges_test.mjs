// Keys continue while a change is being sent or the server is away. In the end the server stores
// what the page shows, and no user sees an own change as a change of another user.
import { check, labelsOf, stored, until, withPage } from './browser.mjs';
import { draw, pause, select } from './hands.mjs';

const shownWidth = async (page) => Number(await page.inputValue('#label-width'));
const storedWidth = async (page) => (await labelsOf(page))[0].width;
const same = (a, b) => Math.abs(a - b) < 0.006; // the field shows centimetres

// Each key is a change of its own: the pauses are longer than the time after which the page sends.
async function widen(page, times) {
  for (let i = 0; i < times; ++i) {
    await page.keyboard.press(']');
    await pause(400);
  }
}

const labelOf = async (page, id) => (await labelsOf(page)).find((label) => label.id === id);
const conflicts = (page) => page.locator('#conflict[open]').count();
const waits = (page) => until(async () => (await page.textContent('#status')).includes('not saved yet'), 'it waits');

// Changes of labels are on their way, but those of bob, until what this returns is called.
async function hold(page) {
  let release = () => {};
  const held = new Promise((done) => (release = done));
  await page.route('**/api/labels/*', async (route) => {
    if (!route.request().postData().includes('"bob"')) await held;
    await route.continue().catch(() => {}); // the page may have been loaded again
  });
  return async () => {
    await page.unroute('**/api/labels/*');
    release();
  };
}

// Another user changes labels.
const bobSees = (page, labels) =>
  page.evaluate(async (list) => {
    const headers = { 'Content-Type': 'application/json' };
    for (const { id, version } of list) {
      const body = JSON.stringify({ note: 'seen', version, who: 'bob', request: `b${id}` });
      await fetch(`api/labels/${id}`, { method: 'PUT', headers, body });
    }
  }, labels);

await withPage(async ({ page, spaces, server }) => {
  await page.keyboard.press('d');
  await draw(page, spaces[4]);
  await page.keyboard.press('d');
  await until(async () => (await shownWidth(page)) > 0, 'it is selected');

  // The server is slow: replies arrive while keys continue.
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
  await until(async () => (await page.textContent('#status')).includes('2 changes not saved yet'), 'two wait');
  await server.start();
  await until(async () => same(await storedWidth(page).catch(() => 0), drawn.width + 0.5), 'both are stored later');
  await until(async () => !(await page.textContent('#status')).includes('not saved'), 'nothing waits any more');
  check((await page.locator('#conflict[open]').count()) === 0, 'the second is no conflict with the first');
  check(same(await shownWidth(page), await storedWidth(page)), 'what is shown is what is stored, again');

  // A class, a note and a length keep their keys too: keys change their meaning with the field.
  await page.keyboard.press('d');
  for (const i of [0, 8]) await draw(page, spaces[i]);
  await page.keyboard.press('d');
  const [one, two, three] = (await labelsOf(page)).map((label) => label.id);
  const was = await labelOf(page, three);
  let release = await hold(page);
  await page.selectOption('#label-kind', 'crossing');
  for (const [field, value] of [['note', 'narrow'], ['length', '4.5']]) {
    await page.fill(`#label-${field}`, value);
    await page.keyboard.press('Tab');
  }
  await page.focus('#map');
  await page.keyboard.press('ArrowLeft');
  await pause(500);
  await release();
  await until(async () => (await labelOf(page, three)).version === was.version + 4, 'four changes are stored');
  const made = await labelOf(page, three);
  check(made.kind === 'crossing' && made.note === 'narrow', 'the class and the note stay');
  check(same(made.length, 4.5) && Math.abs(was.x - made.x - 0.05) < 1e-3, 'the length too, and the key moves it');
  check((await conflicts(page)) === 0, 'none met another as somebody else\'s');

  // Keys that began before the answer arrived and continue after it.
  release = await hold(page);
  await page.selectOption('#label-kind', 'parking_space');
  await page.focus('#map');
  await page.keyboard.press('ArrowLeft');
  await release();
  await until(async () => (await labelOf(page, three)).version === made.version + 2, 'both are stored');
  check((await labelOf(page, three)).kind === 'parking_space', 'again with the class that was given');
  check((await conflicts(page)) === 0, 'and without a conflict');

  // Del deletes what was selected when it was pressed.
  await select(page, two, spaces[0]);
  await server.kill('SIGKILL');
  await page.keyboard.press('ArrowLeft');
  await waits(page);
  await page.keyboard.press('Delete');
  await select(page, three, spaces[8]);
  await server.start();
  const ids = async () => (await labelsOf(page).catch(() => [])).map((label) => label.id).join();
  await until(async () => ['1,2', '1,3', '2,3'].includes(await ids()), 'one is deleted later');
  check((await ids()) === `${one},${three}`, 'the one that was selected');
  await until(async () => !(await page.textContent('#status')).includes('not saved'), 'nothing waits any more');

  // A change behind a waiting change waits too, and survives the page.
  const [before] = await labelsOf(page);
  await select(page, one, spaces[4]);
  release = await hold(page);
  await page.keyboard.press('ArrowLeft');
  await page.fill('#label-note', 'wrong');
  await page.keyboard.press('Tab');
  await page.focus('#map');
  await page.keyboard.press('Control+z');
  await select(page, three, spaces[8]);
  await page.keyboard.press('Delete');
  await pause(100);
  await page.reload();
  await release();
  await stored(page);
  await until(async () => (await ids()) === String(one), 'Del is sent by the page as it was loaded again');
  const after = await labelOf(page, one);
  check(after.version === before.version + 3 && after.note === '', 'so are a note and the undo of it');
  check(Math.abs(before.x - after.x - 0.05) < 1e-3, 'and the key before them');
  await page.keyboard.press('Control+z');
  await until(async () => (await ids()) === `${one},${three}`, 'it knows them as its own');

  // What keys have just left is not lost to a reload.
  await page.keyboard.press('0');
  await pause(400);
  await select(page, one, spaces[4]);
  await page.keyboard.press('Shift+ArrowLeft');
  await page.reload();
  await stored(page);
  await until(async () => Math.abs(after.x - (await labelOf(page, one)).x - 0.5) < 1e-3, 'the last key is stored');

  // The page reports changes of another user one after another, and does not overwrite them.
  const then = await labelsOf(page);
  await page.keyboard.press('0');
  await pause(400);
  release = await hold(page);
  await select(page, one, spaces[4]);
  await widen(page, 1);
  await bobSees(page, then.filter(({ id }) => id === one));
  await until(async () => (await page.textContent('#hint')).includes(`bob changed label ${one}`), 'the page hears of bob');
  await widen(page, 1);
  await select(page, three, spaces[8]);
  await widen(page, 1);
  await bobSees(page, then.filter(({ id }) => id === three));
  await release();
  const asked = (id) => until(async () => (await page.textContent('#conflict-table')).includes(`label ${id}`), `label ${id} is asked about`);
  await asked(one);
  check((await labelsOf(page)).every((label) => label.note === 'seen'), 'what bob stored stands until somebody decides');
  await pause(300);
  check(same((await labelOf(page, one)).width, then[0].width), 'keys that went on after his word are asked about, too');
  await page.click('#conflict-mine');
  await asked(three);
  check((await conflicts(page)) === 1, 'the other conflict comes next');
  await page.click('#conflict-mine');
  const wider = async (i, by) => same((await labelOf(page, then[i].id)).width, then[i].width + by);
  await until(async () => (await wider(0, 0.1)) && (await wider(1, 0.05)), 'each choice is stored, of all keys');
  check((await labelsOf(page)).every((label) => label.note === 'seen'), 'on top of what bob has said');
  check((await conflicts(page)) === 0, 'and nothing is left to decide');
  check((await server.kill('SIGTERM')) === 0, 'the server ends cleanly');
});
