// By keyboard alone; two people at once; many labels; names on every control.
import { check, clickPlace, labelsOf, stored, until, withPage } from './browser.mjs';

// Controls without a name that a screen reader could say.
const nameless = (page) =>
  page.evaluate(() =>
    [...document.querySelectorAll('button, input, select, [tabindex], [role=listbox]')]
      .filter((e) => {
        const label = e.getAttribute('aria-label') ?? e.closest('label')?.textContent ?? '';
        return !(label + (e.matches('button, h2') ? e.textContent + (e.title ?? '') : '')).trim();
      })
      .map((e) => e.outerHTML.slice(0, 80)),
  );

// Pressed without a rest in between, however slow the machine is.
const pressAll = (page, keys) =>
  page.evaluate((pressed) => {
    for (const name of pressed) {
      const [key, shiftKey] = name.startsWith('Shift+') ? [name.slice(6), true] : [name, false];
      document.activeElement.dispatchEvent(new KeyboardEvent('keydown', { key, shiftKey, bubbles: true, cancelable: true }));
    }
  }, keys);

async function change(page, keys, what) {
  const before = JSON.stringify(await labelsOf(page));
  if (keys.length > 1) await pressAll(page, keys);
  else await page.keyboard.press(keys[0]);
  await until(async () => JSON.stringify(await labelsOf(page)) !== before, what);
  return labelsOf(page);
}

await withPage(async ({ page, browser, server }) => {
  check((await nameless(page)).length === 0, `every control has a name: ${await nameless(page)}`);

  // Corners at the cross in the middle, the map moved in between.
  await page.keyboard.press('d');
  await page.keyboard.press(' ');
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press(' ');
  await page.keyboard.press('ArrowUp');
  let labels = await change(page, [' '], 'a box drawn by keys is stored');
  check(labels.length === 1, 'one label');
  const first = labels[0];
  labels = await change(page, ['ArrowLeft', 'ArrowLeft', 'Shift+ArrowUp'], 'a move is stored');
  check(Math.abs(labels[0].x - (first.x - 0.1)) < 1e-3, 'two small steps to the left');
  check(Math.abs(labels[0].y - (first.y + 0.5)) < 1e-3, 'a large one up');
  check(labels[0].version === 2, 'as one change');
  labels = await change(page, ['z', 'c'], 'a turn is stored');
  check(Math.abs(labels[0].heading - first.heading - (9 * Math.PI) / 180) < 1e-3, 'by 10 degrees less 1');
  labels = await change(page, ['p'], 'one more beside it');
  labels = await change(page, ['p'], 'and one at the same spacing');
  const [a, b, c] = labels;
  check(Math.hypot(a.x - 2 * b.x + c.x, a.y - 2 * b.y + c.y) < 1e-3, 'three in a row, evenly');
  labels = await change(page, ['Control+z'], 'undo');
  check(labels.length === 2, 'takes the last one back');
  await page.selectOption('#list-what', 'labels');
  await page.selectOption('#list-order', 'number');
  await page.focus('#rows');
  await page.keyboard.press('End');
  labels = await change(page, ['Delete'], 'the other is deleted');
  check(labels.length === 1, 'one is left');
  await page.focus('#map');
  await page.keyboard.press('Escape');
  await page.keyboard.press('Escape');

  // A crossing.
  await page.keyboard.press('2');
  await page.keyboard.press('d');
  for (const corner of [[5, -1.5], [8, -1.5], [8, 1.5], [5, 1.5]]) await clickPlace(page, ...corner);
  labels = await change(page, ['Enter'], 'a polygon is stored');
  const crossing = labels.find((l) => l.kind === 'crossing');
  check(crossing.shape === 'polygon' && crossing.corners.length === 4, 'with its four corners');
  await page.keyboard.press('Escape');
  await page.keyboard.press('Escape');

  // Another person changes what this one is about to change.
  const other = await (await browser.newContext()).newPage();
  await other.goto(server.address);
  await stored(other);
  await other.fill('#who', 'bob');
  await other.dispatchEvent('#who', 'change');
  const id = labels[0].id;
  const put = (who, width) =>
    other.evaluate(
      async ([label, name, value]) => {
        const body = { ...label, who: name, width: value };
        const response = await fetch(`api/labels/${label.id}`, {
          method: 'PUT',
          headers: { 'Content-Type': 'application/json' },
          body: JSON.stringify(body),
        });
        return { status: response.status, json: await response.json() };
      },
      [labels.find((l) => l.id === id), who, width],
    );
  check((await put('bob', 2.4)).status === 200, 'the first of two changes is stored');
  const conflict = await put('ann', 2.6);
  check(conflict.status === 409, 'the second is a conflict');
  check(conflict.json.current.width === 2.4 && conflict.json.yours.width === 2.6, 'that tells both');
  await until(
    async () => (await page.textContent('#hint')).includes(`bob changed label ${id}`),
    'the other page hears of it',
  );

  // This page's own change meets a newer version that it has not heard of.
  await page.route('**/api/labels/*', async (route) => {
    await other.evaluate(async (label) => {
      const now = (await (await fetch('api/labels')).json()).labels.find((l) => l.id === label);
      await fetch(`api/labels/${label}`, {
        method: 'PUT',
        headers: { 'Content-Type': 'application/json' },
        body: JSON.stringify({ ...now, who: 'bob', width: 3.0 }),
      });
    }, id);
    await route.continue();
  }, { times: 1 });
  await page.focus('#rows');
  await page.keyboard.press('Home');
  await page.focus('#map');
  await page.keyboard.press(']');
  await until(() => page.isVisible('#conflict'), 'the conflict is shown');
  check((await page.textContent('#conflict-table')).includes('bob'), 'with who it was');
  await page.click('#conflict-mine');
  await until(async () => {
    const label = (await labelsOf(page)).find((l) => l.id === id);
    return label.who === 'ann' && label.width < 3.0;
  }, 'mine is taken when asked for');

  // Escaped: what a person writes is text.
  await page.fill('#label-note', '<img src=x onerror="document.title=1">');
  await page.dispatchEvent('#label-note', 'change');
  await until(async () => (await page.textContent('#rows')).includes('<img src=x'), 'a note is shown as text');
  check((await page.locator('#rows img').count()) === 0, 'and not as markup');
});
