// A user types a note of a label while another user deletes the label. The text stays, and the page
// asks.
import { check, labelsOf, until, withPage } from './browser.mjs';
import { draw, hint, select, showAll, subject } from './hands.mjs';

const idsOf = async (page) => (await labelsOf(page)).map(({ id }) => id).join();

const bobDeletes = async (page, { id, version }) => {
  const status = await page.evaluate(async ([path, body]) => {
    const headers = { 'Content-Type': 'application/json' };
    return (await fetch(path, { method: 'DELETE', headers, body: JSON.stringify(body) })).status;
  }, [`api/labels/${id}`, { version, who: 'bob' }]);
  check(status === 200, `bob deletes label ${id}`);
  await until(async () => (await hint(page)) === `bob deleted label ${id}`, 'the page says so');
};

// The label is deleted in the middle of the word.
async function typed(page, label, space) {
  await select(page, label.id, space);
  await page.focus('#label-note');
  await page.keyboard.type('nar');
  await bobDeletes(page, label);
  await until(async () => (await subject(page)).endsWith(`${label.id} was deleted`), 'and whose note this is');
  await page.keyboard.type('row');
  check((await page.inputValue('#label-note')) === 'narrow', 'what is typed has its place');
  await page.keyboard.press('Tab');
  await until(() => page.isVisible('#conflict'), 'left, it is asked about');
  const table = await page.textContent('#conflict-table');
  check(table.includes('deleted') && table.includes('narrow'), `with what was typed: ${table}`);
  check(await page.isHidden('#properties'), 'once');
}

await withPage(async ({ page, spaces, server }) => {
  await page.keyboard.press('d');
  for (const i of [0, 2, 4]) await draw(page, spaces[i]);
  await page.keyboard.press('d');
  await showAll(page);
  const [first, second, third] = await labelsOf(page);

  await typed(page, first, spaces[0]);
  await page.keyboard.press('Space'); // the user continues to type and has not answered
  check(await page.isVisible('#conflict'), 'a key that was meant for a field answers nothing');
  await page.click('#conflict-mine');
  await until(async () => (await labelsOf(page))[0].note === 'narrow', 'the label is there again, with its note');
  await until(async () => (await page.isVisible('#properties')) && (await page.inputValue('#label-note')) === 'narrow', 'and shown');

  await typed(page, second, spaces[2]);
  await page.click('#conflict-theirs');
  await until(async () => (await subject(page)) === 'Nothing selected', 'or it stays deleted');
  check((await idsOf(page)) === `${first.id},${third.id}`, 'as bob has left it');

  // A user who entered a field and typed nothing is not asked.
  await select(page, third.id, spaces[4]);
  await page.focus('#label-length');
  await bobDeletes(page, third);
  await until(async () => (await subject(page)).endsWith(`${third.id} was deleted`), 'the third is deleted');
  await page.keyboard.press('Tab');
  check(await page.isVisible('#properties'), 'the fields are there for as long as somebody is in one');
  await page.focus('#map');
  await until(() => page.isHidden('#properties'), 'and go when he leaves them');
  check((await subject(page)) === 'Nothing selected' && (await page.isHidden('#conflict')), 'nothing was to be asked');
  check((await server.kill('SIGTERM')) === 0, 'the server ends cleanly');
});
