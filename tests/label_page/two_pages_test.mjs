// Two pages of one browser, one person: neither takes the other's work back unnoticed, nor sends or
// loses what the other has not sent yet, nor gets the other's name.
import { check, clickPlace, labelsOf, stored, threeClicks, until, withPage } from './browser.mjs';

const status = (page) => page.textContent('#status');
const hint = (page) => page.textContent('#hint');
const waits = (page, count) => until(async () => (await status(page)).includes(`${count} not stored yet`), `${count} wait`);

async function draw(page, space) {
  const before = (await labelsOf(page)).length;
  for (const corner of threeClicks(space)) await clickPlace(page, ...corner);
  await until(async () => (await labelsOf(page)).length === before + 1, 'a drawn box is stored');
}

async function drawAway(page, space) {
  for (const corner of threeClicks(space)) await clickPlace(page, ...corner);
}

await withPage(async ({ page: one, spaces, server }) => {
  const two = await one.context().newPage();
  await two.goto(server.address);
  await stored(two);
  for (const page of [one, two]) {
    await page.bringToFront();
    await page.keyboard.press('d');
  }

  // What was done in the other page since is told, and taken back by the second press alone.
  await one.bringToFront();
  await draw(one, spaces[0]);
  await two.bringToFront();
  await draw(two, spaces[2]);
  const ids = async () => (await labelsOf(one)).map((label) => label.id).join();
  const [first, second] = (await ids()).split(',');
  await one.bringToFront();
  await one.keyboard.press('Control+z');
  await until(async () => (await hint(one)).includes(`label ${second}, in another page`), 'the page says what it would undo');
  check((await ids()) === `${first},${second}`, 'and has taken nothing back');
  await one.keyboard.press('Control+z');
  await until(async () => (await ids()) === first, 'once more takes it back');
  await one.keyboard.press('Control+y');
  await until(async () => (await ids()) === `${first},${second}`, 'redo brings it again');

  // A name that is given in one page is the other's only when that is opened anew.
  await two.bringToFront();
  await two.fill('#who', 'bob');
  await two.keyboard.press('Tab');
  await one.reload();
  await stored(one);
  check((await one.inputValue('#who')) === 'ann', 'a page keeps its name when it is loaded again');

  // Both wait for the server; one is closed; the other, loaded again, sends what both have left.
  await server.kill('SIGKILL');
  await one.bringToFront();
  await one.focus('#map');
  await one.keyboard.press('d');
  await drawAway(one, spaces[4]);
  await waits(one, 1);
  await two.bringToFront();
  await two.focus('#map');
  await drawAway(two, spaces[6]);
  await drawAway(two, spaces[8]);
  await waits(two, 2);
  check((await status(one)).includes('1 not stored yet'), 'each counts its own');
  await two.close();
  await server.start();
  await until(async () => (await labelsOf(one).catch(() => [])).length === 3, 'the first sends its own');
  await one.waitForTimeout(1500);
  check((await labelsOf(one)).length === 3, 'and no more');
  await one.reload();
  await stored(one);
  await until(async () => (await labelsOf(one)).length === 5, 'what the closed page has left goes out with the next');
  const kept = await one.evaluate(() => Object.keys(localStorage).filter((key) => key !== 'roadbook_who'));
  check(kept.length === 0, `nothing waits any more: ${kept}`);
  check((await server.kill('SIGTERM')) === 0, 'the server ends cleanly');
});
