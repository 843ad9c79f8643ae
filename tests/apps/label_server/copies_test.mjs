// Two files of one map, labelled apart: their drives and poses are the same, and so are the numbers and
// versions of labels, but a change that was made on the one does not go into the other unasked.
import { cpSync } from 'node:fs';
import { check, labelsOf, stored, until, withPage } from './browser.mjs';
import { draw, select, showAll, status } from './hands.mjs';

const first = async (page) => (await labelsOf(page))[0];

await withPage(async ({ page, spaces, server }) => {
  await page.keyboard.press('d');
  await draw(page, spaces[0]);
  await page.keyboard.press('d');
  await server.kill('SIGTERM');
  const [own, copy] = [server.map, `${server.map}.copy.gpkg`];
  cpSync(own, copy);
  const serve = async (map) => {
    server.map = map;
    await server.start();
    await until(async () => (await labelsOf(page).catch(() => [])).length === 1, 'the page meets the server');
  };

  // Bob works on the copy.
  await serve(copy);
  const { width } = await first(page);
  const answer = await page.evaluate(async () => {
    const body = JSON.stringify({ width: 3.5, note: 'of the copy', version: 1, who: 'bob', request: 'b' });
    return (await fetch('api/labels/1', { method: 'PUT', headers: { 'Content-Type': 'application/json' }, body })).status;
  });
  check(answer === 200, 'bob changes the label in the copy');

  // Ann continues with the first file. Her last change waits until the copy is served again.
  await server.kill('SIGTERM');
  await serve(own);
  await page.reload();
  await stored(page);
  await showAll(page);
  await select(page, 1, spaces[0]);
  await page.keyboard.press(']');
  await until(async () => (await first(page)).version === 2, 'a change of the first file is stored');
  await server.kill('SIGTERM');
  await page.keyboard.press('ArrowLeft');
  await until(async () => (await status(page)).includes('1 change not saved yet'), 'another waits');
  const [waiting] = await page.evaluate(() => JSON.parse(localStorage.getItem(Object.keys(localStorage).find((key) => key.includes('/')))).changes);
  check(Object.keys(waiting.body).sort().join() === 'map,request,version,when,who,x', 'it says what it changes');
  const { pose, ...shape } = waiting.later;
  check(Object.keys(shape).sort().join() === 'heading,length,shape,width,x,y', 'and for a map built anew all of the shape');
  check(Math.abs(pose.x - shape.x) < 1 && pose.y === 0 && /^14\d{17}$/.test(pose.t_ns), 'beside its vehicle');
  await serve(copy);
  await until(() => page.isVisible('#conflict'), 'the copy is told apart by its history');
  const text = await page.textContent('#conflict-table');
  check(text.includes('bob') && text.includes('of the copy'), `both are shown: ${text}`);
  check((await first(page)).width === 3.5, 'and nothing is written over');
  await page.click('#conflict-theirs');
  await stored(page);
  check((await first(page)).version === 2, 'what stands there stays');

  // In the file that it was made on there is nothing to ask.
  await server.kill('SIGTERM');
  await serve(own);
  await page.reload();
  await stored(page);
  check(Math.abs((await first(page)).width - width - 0.05) < 0.006, 'the first file has what was stored in it');
});
