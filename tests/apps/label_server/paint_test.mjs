// A car park was driven again after it was labelled, in a map that is bent. The page lists labels
// whose paint is missing. For labels that were found again it shows in how many images and how far
// off. This is stored until a user changes the label.
import { check, labelsOf, stored, until, withPage } from './browser.mjs';
import { select, showAll } from './hands.mjs';

const paintOf = (page) => page.evaluate(async () => (await fetch('api/paint')).json());
const told = (page) => page.textContent('#further');

await withPage(async ({ page, spaces, server }) => {
  const all = await labelsOf(page);
  check(all.length === spaces.length, 'the labels are there');
  await until(async () => (await paintOf(page)).looked === all.length, 'all labels are looked for', 120000);
  let report;
  await until(async () => (report = await paintOf(page)).further.length >= 18, 'most are found again');

  // Where the bend begins it is small; 25 m on it is not.
  const place = (id) => spaces[id - 1];
  const right = report.further.filter(({ id }) => place(id)[1] < 0);
  const bent = right.find(({ id }) => place(id)[0] > 18);
  const even = right.find(({ id }) => place(id)[0] < 6);
  check(bent.contradicts && !even.contradicts, 'the far one contradicts the map, the near one does not');
  await showAll(page);
  await select(page, even.id, place(even.id));
  await until(() => page.isVisible('#further'), 'the page tells of the further image');
  const centimetres = `${(100 * even.apart_m).toFixed(0)} cm`;
  check((await told(page)).includes(`Also found in another image: drive1, ${even.images[0].camera}, ${centimetres} from here (${even.sigmas.toFixed(1)} `), await told(page));
  check(/agrees with the poses/.test(await told(page)), 'and that the poses agree');
  await select(page, bent.id, place(bent.id));
  await until(async () => /larger than the poses allow/.test(await told(page)), 'where it does not fit the page says so');
  check(await page.evaluate(() => document.querySelector('#further').classList.contains('bad')), 'in another colour');
  await page.selectOption('#list-what', 'labels');
  await page.fill('#search', `${bent.id} `);
  check((await page.textContent('#rows')).includes('cm between images'), 'and in the list');
  await page.fill('#search', '');

  // Labels with missing paint are in the list of labels to check.
  await page.selectOption('#list-what', 'look');
  await until(async () => (await page.textContent('#rows')).includes('paint missing'), 'labels whose paint is gone are to be looked at');

  // Stored: a server that has just begun knows it before it has looked again.
  const before = await page.evaluate(async () => (await (await fetch('api/history')).json()).events.length);
  await server.kill('SIGTERM');
  await server.start();
  const known = (await paintOf(page)).further.map(({ id, apart_m }) => `${id} ${apart_m.toFixed(3)}`);
  check(known.join() === report.further.map(({ id, apart_m }) => `${id} ${apart_m.toFixed(3)}`).join(), 'what was found is stored');
  const after = await page.evaluate(async () => (await (await fetch('api/history')).json()).events.length);
  check(after === before && (await labelsOf(page)).every(({ version }) => version === 1), 'and no label is changed by it');

  // It is of the label as it was.
  await page.reload();
  await stored(page);
  await showAll(page);
  await select(page, bent.id, place(bent.id));
  await until(() => page.isVisible('#further'), 'it is told again');
  await page.keyboard.press(']');
  await until(() => page.isHidden('#further'), 'until the label is changed');
  await until(async () => (await labelsOf(page)).find(({ id }) => id === bent.id).version === 2, 'which is stored');
  check((await paintOf(page)).further.every(({ id }) => id !== bent.id), 'on the server too');
});
