// A page stays open while its map is built again, or while another map takes its place. The page
// never mixes two maps. After a reload it reports its unsent changes: the user sends, saves or
// discards them.
import { cpSync, readFileSync } from 'node:fs';
import { spawnSync } from 'node:child_process';
import { check, labelsOf, stored, until, withPage } from './browser.mjs';
import { clickCorners, draw, hold, select, showAll, status } from './hands.mjs';

const kept = (page) => page.evaluate(() => Object.keys(localStorage).filter((key) => key.includes('/')));
const kMoved = 2; // shift of the poses of the rebuilt map along x; then they are turned
const kTurned = 0.05;
const anewAt = ([x, y]) => {
  const [c, s] = [Math.cos(kTurned), Math.sin(kTurned)];
  return [c * (x + kMoved) - s * y, s * (x + kMoved) + c * y];
};
const left = (page) => page.textContent('#left');

await withPage(async ({ page, spaces, server, makeLot }) => {
  await page.keyboard.press('d');
  await draw(page, spaces[0]);
  await page.keyboard.press('d');
  const first = server.map;
  const again = `${first}.again.gpkg`;
  cpSync(first, again);

  // The same map under another name: no message, and waiting changes are sent.
  await server.kill('SIGKILL');
  await page.keyboard.press('d');
  await clickCorners(page, spaces[2]);
  await until(async () => (await status(page)).includes('1 change not saved yet'), 'a box waits');
  server.map = again;
  await server.start();
  await until(async () => (await labelsOf(page).catch(() => [])).length === 2, 'a copy of the map takes it');
  check(!(await page.isVisible('#other-map')), 'and the page goes on');

  // The map is built again: other poses, same labels. The page has unsent changes.
  const anew = `${first}.anew.gpkg`;
  spawnSync(makeLot, [anew, 1, 12, 0, kMoved, kTurned]);
  await server.kill('SIGKILL');
  await clickCorners(page, spaces[4]);
  await clickCorners(page, spaces[6]);
  await until(async () => (await status(page)).includes('2 changes not saved yet'), 'two boxes wait');
  server.map = anew;
  await server.start();
  await until(() => page.isVisible('#other-map'), 'the page says that the map is another');
  check(/another map.*2 changes are not saved yet and kept/.test(await page.textContent('#other-map-text')), await page.textContent('#other-map-text'));
  await page.keyboard.press('Escape');
  await page.waitForTimeout(1500);
  check(await page.isVisible('#other-map'), 'and goes on saying so');
  check((await labelsOf(page)).length === 0, 'nothing of the older map goes into the new one');
  check((await kept(page)).length === 1, 'it stays in the browser');

  // After a reload the page reports the changes. Here it can send them, because the place is the
  // same.
  await page.click('#other-map-load');
  await stored(page);
  await until(() => page.isVisible('#left'), 'what is left is told');
  check(/2 changes not saved: made on lot before this map was rebuilt/.test(await left(page)), await left(page));
  const [download] = await Promise.all([page.waitForEvent('download'), page.click('#left button:text("Save")')]);
  const saved = JSON.parse(readFileSync(await download.path(), 'utf8'));
  check(saved.changes.length === 2 && saved.changes[0].body.kind === 'parking_space', 'it can be saved as a file');
  await page.click('#left button:text("Send")');
  await until(async () => (await labelsOf(page)).length === 2, 'and sent');
  await until(() => page.isHidden('#left'), 'then nothing is left');
  check((await kept(page)).length === 0, 'nor kept');
  for (const [i, space] of [spaces[4], spaces[6]].entries()) {
    const { x, y, heading } = (await labelsOf(page))[i];
    const [u, v] = anewAt(space);
    check(Math.hypot(x - u, y - v) < 0.1, `beside the vehicle as it is now: ${x}, ${y} for ${u}, ${v}`);
    check(Math.abs(Math.sin(heading - space[2] - kTurned)) < 0.03, 'turned with it');
  }

  // A change that the page makes before it has noticed is refused by the server.
  const [label] = await labelsOf(page);
  const refused = await page.evaluate(async (id) => {
    const body = JSON.stringify({ who: 'ann', version: 1, map: '0123456789abcdef', note: 'x' });
    const answer = await fetch(`api/labels/${id}`, { method: 'PUT', headers: { 'Content-Type': 'application/json' }, body });
    return { status: answer.status, ...(await answer.json()) };
  }, label.id);
  check(refused.status === 409 && refused.error.includes('made on another map'), `${refused.status}: ${refused.error}`);
  const silent = await hold(page, '**/api/events', 'GET', (route) => route.abort());
  await server.kill('SIGKILL');
  server.map = first;
  await server.start();
  await showAll(page);
  await select(page, label.id, [label.x, label.y]);
  await page.keyboard.press('ArrowLeft');
  await until(() => page.isVisible('#other-map'), 'a change that goes to another map is refused, and the page says why');
  await silent();
  check((await labelsOf(page)).every(({ version }) => version === 1), 'the label of that number is not touched');
  // The same holds for reads: the page neither trains on another map nor shows it.
  const named = [];
  page.on('request', (request) => request.method() === 'POST' && named.push([new URL(request.url()).pathname, request.postDataJSON().map]));
  await page.reload();
  await stored(page);
  await page.keyboard.press('t');
  await until(() => named.some(([path]) => path === '/api/learn'), 'it is asked to learn');
  check(named.every(([, map]) => /^[0-9a-f]{16}$/.test(map ?? '')), `each names its map: ${JSON.stringify(named)}`);

  // A change of another place is reported, not sent.
  await page.evaluate(() => {
    const changes = [{ request: 'r', method: 'DELETE', path: 'api/labels/1', body: { version: 1, request: 'r', who: 'ann' } }];
    localStorage.setItem('roadbook_00/elsewhere', JSON.stringify({ name: 'garage', place: '00', changes }));
  });
  await page.reload();
  await stored(page);
  await until(async () => (await left(page)).includes('1 change not saved: made on another map, garage'), 'changes of another place are told');
  const lines = page.locator('#left li', { hasText: 'garage' });
  check((await lines.locator('button:text("Send")').count()) === 0, 'and cannot be sent here');
  page.on('dialog', (dialog) => dialog.accept());
  for (let i = await page.locator('#left li').count(); i > 0; --i) await page.click('#left li:first-child button:text("Discard")');
  await until(() => page.isHidden('#left'), 'but discarded');
  check((await kept(page)).length === 0 && (await labelsOf(page)).length === 1, 'with nothing sent');

  // A change of this place from a page that named no keyframe: its current place is unknown.
  await page.evaluate(async () => {
    const { place, name } = await (await fetch('api/start')).json();
    const body = { shape: 'box', x: 1, y: 5, heading: 1.6, length: 5, width: 2.5, kind: 'parking_space', source: 'drawn', score: 1, note: '', who: 'ann', request: 's' };
    const changes = [{ request: 's', method: 'POST', path: 'api/labels', body }];
    localStorage.setItem('roadbook_0123456789abcdef/older', JSON.stringify({ name, place, changes }));
  });
  await page.reload();
  await stored(page);
  const count = (await labelsOf(page)).length;
  await page.click('#left button:text("Send")');
  await until(async () => (await left(page)).includes('the rebuilt map has no pose for this place'), 'it is told why it is not sent');
  check((await labelsOf(page)).length === count, 'and not stored in another place');
  await page.click('#left button:text("Discard")');
  await until(() => page.isHidden('#left'), 'it can be discarded');

  // Another overhead image of the same map: the page is loaded again, and sends what waited.
  const painted = `${first}.painted.gpkg`;
  spawnSync(makeLot, [painted, 1, 10, 1000]);
  await server.kill('SIGKILL');
  await page.focus('#map');
  await page.keyboard.press('d');
  await clickCorners(page, spaces[8]);
  await until(async () => (await status(page)).includes('1 change not saved yet'), 'a box waits');
  server.map = painted;
  await server.start();
  await until(() => page.isVisible('#other-map'), 'the page says that the picture is another');
  check((await page.textContent('#other-map-text')).includes('another overhead image'), 'in words');
  await page.click('#other-map-load');
  await stored(page);
  await until(async () => (await labelsOf(page)).length === 1, 'what waited is stored');
  check(await page.isHidden('#left'), 'and nothing is left');

  // A page that has nothing to send notices too.
  await server.kill('SIGKILL');
  server.map = anew;
  await server.start();
  await until(() => page.isVisible('#other-map'), 'a page that only looks on says that the map is another');
  check((await server.kill('SIGTERM')) === 0, 'the server ends cleanly');
});
