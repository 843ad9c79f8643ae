// Classes: two people change them at once, and neither silently undoes the other's change.
import { check, stored, until, withPage } from './browser.mjs';

const titleOf = (row) => `#classes-table tbody tr:nth-child(${row}) [name=title]`;
const inMap = (page) => page.evaluate(async () => (await (await fetch('api/start')).json()).classes);
const first = async (page) => (await inMap(page)).classes[0].title;

async function save(page, title) {
  await page.click('#edit-classes');
  await page.fill(titleOf(1), title);
  await page.click('#classes-save');
}

await withPage(async ({ page, browser, server }) => {
  const other = await (await browser.newContext()).newPage();
  await other.goto(server.address);
  await stored(other);
  await other.fill('#who', 'bob');
  await other.dispatchEvent('#who', 'change');

  // Ann has the dialog open while Bob stores his.
  await page.click('#edit-classes');
  await page.fill(titleOf(1), 'stall');
  await save(other, 'bay');
  await until(async () => (await first(page)) === 'bay', 'the first is stored');
  await until(async () => (await page.textContent('#classes')).includes('bay'), 'and shown to the other');
  await page.click('#classes-save');
  await until(() => page.isVisible('#conflict'), 'the second is asked');
  const table = await page.textContent('#conflict-table');
  check(['bob', 'bay', 'stall', 'parking_space'].every((word) => table.includes(word)), `with both: ${table}`);
  check((await first(page)) === 'bay', 'and nothing is stored before the answer');
  await page.click('#conflict-theirs');
  check((await first(page)) === 'bay' && !(await page.isVisible('#conflict')), 'theirs stays when it is kept');

  await page.click('#edit-classes');
  check((await page.inputValue(titleOf(1))) === 'bay', 'the dialog begins with what there is');
  await page.fill(titleOf(1), 'stall');
  await save(other, 'berth');
  await until(async () => (await first(page)) === 'berth', 'bob again');
  await page.click('#classes-save');
  await until(() => page.isVisible('#conflict'), 'asked again');
  await page.click('#conflict-mine');
  await until(async () => (await first(page)) === 'stall', 'mine is taken when asked for');
  await until(async () => (await other.textContent('#classes')).includes('stall'), 'and told');
  check((await inMap(page)).version === 3 && (await inMap(page)).who === 'ann', 'a version each');

  // The page keeps a change that the server refused, and stores it once.
  await page.click('#edit-classes');
  await page.fill(titleOf(1), 'spot');
  await server.kill('SIGKILL');
  await page.click('#classes-save');
  await until(async () => (await page.textContent('#status')).includes('not saved yet'), 'the page says so');
  await server.start();
  await until(async () => (await first(page).catch(() => '')) === 'spot', 'it is stored later');
  await until(async () => !(await page.isVisible('#classes-dialog')), 'and the dialog closes');
  check((await inMap(page)).version === 4, 'once');
  await page.keyboard.press('Control+z');
  await until(async () => (await first(page)) === 'stall', 'undo takes it back');
  check((await server.kill('SIGTERM')) === 0, 'the server ends cleanly');
});
