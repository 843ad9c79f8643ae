// Two pages of one browser and one user: neither reverts the other's work silently, neither sends
// or loses the other's unsent changes, and neither takes the other's user name.
import { check, labelsOf, stored, until, withPage } from './browser.mjs';
import { clickCorners, draw, hint, isAsked, status } from './hands.mjs';

const waits = (page, count) => until(async () => (await status(page)).includes(`${count} change${count === 1 ? '' : 's'} not saved yet`), `${count} wait`);

const boxAt = ([x, y, heading, length, width]) => ({ x, y, heading, length, width });

await withPage(async ({ page: one, spaces, server }) => {
  const two = await one.context().newPage();
  await two.goto(server.address);
  await stored(two);
  for (const page of [one, two]) {
    await page.bringToFront();
    await page.keyboard.press('d');
  }

  // A page that has just been opened reverts no step of another page before it has said so.
  const ids = async () => (await labelsOf(one)).map((label) => label.id).join();
  await one.bringToFront();
  await draw(one, spaces[0]);
  await two.bringToFront();
  await two.keyboard.press('Control+z');
  await until(async () => (await hint(two)).includes('in another page'), 'a fresh page says what it would undo');
  check((await ids()) === '1', 'and has taken nothing back');
  await two.keyboard.press('Control+z');
  await until(async () => (await ids()) === '', 'once more takes it back');

  // The page reports steps of the other page first, and reverts them only on a second press.
  await one.bringToFront();
  await draw(one, spaces[0]);
  await two.bringToFront();
  await draw(two, spaces[2]);
  const [first, second] = (await ids()).split(',');
  await one.bringToFront();
  await one.keyboard.press('Control+z');
  await until(async () => (await hint(one)).includes(`(label ${second}) was made in another page`), 'the page says what it would undo');
  check((await ids()) === `${first},${second}`, 'and has taken nothing back');
  // A step that the other page does after this report is reported again.
  await two.bringToFront();
  await draw(two, spaces[14]);
  const third = (await ids()).split(',')[2];
  await one.bringToFront();
  await until(async () => (await one.textContent('#progress')).includes('3, 3 drawn'), 'the page hears of it');
  await one.keyboard.press('Control+z');
  await until(async () => (await hint(one)).includes(`(label ${third}) was made in another page`), 'it says so again');
  check((await ids()) === `${first},${second},${third}`, 'before it takes anything back');
  for (const left of [`${first},${second}`, first]) {
    await one.keyboard.press('Control+z');
    await until(async () => (await ids()) === left, 'then each press takes one back');
  }
  await one.keyboard.press('Control+y');
  await until(async () => (await ids()) === `${first},${second}`, 'redo brings it again');

  // A name given in one page is used by the other only after a reload.
  await two.bringToFront();
  await two.fill('#who', 'bob');
  await two.keyboard.press('Tab');
  await one.reload();
  await stored(one);
  check((await one.inputValue('#who')) === 'ann', 'a page keeps its name when it is loaded again');
  await one.keyboard.press('Control+z');
  await until(async () => (await ids()) === first, 'and what it did as its own, taken back at once');
  await one.keyboard.press('Control+y');
  await until(async () => (await ids()) === `${first},${second}`, 'and done again');

  // Both wait for the server; one is closed; the other, loaded again, sends what both have left.
  await server.kill('SIGKILL');
  await one.bringToFront();
  await one.focus('#map');
  await one.keyboard.press('d');
  await clickCorners(one, spaces[4]);
  await waits(one, 1);
  await two.bringToFront();
  await two.focus('#map');
  await clickCorners(two, spaces[6]);
  await clickCorners(two, spaces[8]);
  await waits(two, 2);
  check((await status(one)).includes('1 change not saved yet'), 'each counts its own');
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

  // A page closes while it takes over the unsent changes of closed pages: no change is lost, and an
  // unreadable one blocks nothing.
  const map = `roadbook_${await one.evaluate(async () => (await (await fetch('api/start')).json()).map)}`;
  await one.evaluate(
    ([place, left]) => {
      for (const [name, box] of Object.entries(left)) {
        const body = { ...box, kind: 'parking_space', source: 'drawn', score: 1, note: '', shape: 'box', who: 'ann', request: name };
        localStorage.setItem(`${place}/${name}`, JSON.stringify([{ request: name, method: 'POST', path: 'api/labels', body }]));
      }
      localStorage.setItem(`${place}/broken`, '[{"request"');
    },
    [map, { gone: boxAt(spaces[10]), stuck: boxAt(spaces[12]) }],
  );
  const three = await one.context().newPage();
  await three.addInitScript(() => {
    const request = LockManager.prototype.request;
    LockManager.prototype.request = function (name, ...rest) {
      return name.endsWith('_stuck') ? new Promise(() => {}) : request.call(this, name, ...rest);
    };
  });
  await three.goto(server.address);
  await three.waitForTimeout(1500);
  await three.close();
  await one.reload();
  await stored(one);
  await until(async () => (await labelsOf(one)).length === 7, 'all of it goes out with the next');
  check((await labelsOf(one)).length === 7, 'once');

  // A question that one page answered is no question in the other.
  const four = await one.context().newPage();
  await four.goto(server.address);
  await stored(four);
  await four.fill('#who', 'ann');
  await four.keyboard.press('Tab');
  await one.bringToFront();
  await one.keyboard.press('t');
  await until(() => isAsked(one), 'a question comes', 120000);
  await four.bringToFront();
  await four.focus('#map');
  await until(async () => (await four.textContent('#progress')).includes('questions'), 'the other page hears of the round');
  await four.keyboard.press('n');
  await until(() => isAsked(four), 'and asks the same');
  const left = await four.textContent('#subject-text');
  await one.bringToFront();
  await one.keyboard.press('a');
  await until(async () => (await labelsOf(one)).length === 8, 'the answer is stored');
  await until(async () => (await four.textContent('#subject-text')) !== left, 'the other page asks something else', 5000);
  check((await server.kill('SIGTERM')) === 0, 'the server ends cleanly');
});
