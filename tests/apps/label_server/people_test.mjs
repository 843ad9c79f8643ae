// Teaching people in the page: draw two, learn, accept and reject with keys, undo, reload; and a server
// that dies between two clicks. Every answer that the page called stored is there, once.
import { check, labelsOf, stored, until, withPage } from './browser.mjs';
import { clickPixel, draw, imageOf, near, nextImage, peopleIn, showImageWithPeople, untilLearnt, windowsOf } from './people_hands.mjs';

await withPage(async ({ page, spaces: people, server }) => {
  await page.keyboard.press('m');
  await until(() => imageOf(page), 'an image comes by itself');
  const bare = await page.evaluate(() =>
    [...document.querySelectorAll('#people-side button, #people-picture')]
      .filter((e) => !(e.getAttribute('aria-label') ?? e.textContent).trim())
      .map((e) => e.id),
  );
  check(bare.length === 0, `every control has a name: ${bare}`);

  // Two people by clicks, then one by keys alone.
  await showImageWithPeople(page, people);
  const [one, other] = await peopleIn(page, people);
  await page.keyboard.press('d');
  await draw(page, one);
  await draw(page, other);
  await page.keyboard.press('d');
  const drawn = await windowsOf(page);
  check(near(drawn[0], one) && near(drawn[1], other), 'people stand where they were clicked');
  check(drawn.every((l) => l.kind === 'person' && l.who === 'ann'), 'with their name and who drew them');
  check((await page.locator('#people-picture .person').count()) === 2, 'both are drawn into the image');
  await page.keyboard.press('ArrowRight');
  await until(async () => (await windowsOf(page)).some((l) => l.version === 2), 'a nudge is stored');

  // Keys continue while a change is being sent: no key is lost, and no change is sent twice.
  const nudged = (await windowsOf(page)).find((l) => l.version === 2);
  await page.route('**/api/labels/*', async (route) => {
    await new Promise((later) => setTimeout(later, 650));
    await route.continue();
  });
  for (let i = 0; i < 4; ++i) {
    await page.keyboard.press('ArrowRight');
    await page.waitForTimeout(400);
  }
  const sameLabel = async () => (await windowsOf(page)).find((l) => l.id === nudged.id);
  // Feet are stored as places on the ground, which come back to a thousandth of a pixel.
  await until(async () => Math.abs((await sameLabel()).foot[0] - nudged.foot[0] - 4) < 0.01, 'all four nudges are stored');
  check((await page.locator('#conflict[open]').count()) === 0, 'without a conflict among them');
  await page.unroute('**/api/labels/*');

  // Undo reverts moves by keys, sent or not.
  await page.waitForTimeout(1000);
  const before = await sameLabel();
  await page.keyboard.press('ArrowLeft');
  await page.keyboard.press('Control+z');
  await until(async () => (await sameLabel())?.version === before.version + 2, 'a nudge is stored and taken back');
  check(Math.abs((await sameLabel()).foot[0] - before.foot[0]) < 0.01, 'and nothing else is');
  await nextImage(page, 'Enter');

  // What was said is learnt in the background; questions come by themselves.
  await until(async () => (await page.textContent('#people-progress')).includes('round 1'), 'a round by itself', 120000);
  for (let i = 0; i < 4; ++i) {
    await showImageWithPeople(page, people);
    const there = await peopleIn(page, people);
    await until(async () => (await imageOf(page)) !== null, 'an image');
    const open = await page.locator('#people-picture .likely').count();
    if (open === 0) {
      await page.keyboard.press('d');
      for (const p of there) await draw(page, p);
      await page.keyboard.press('d');
    }
    await nextImage(page, 'Enter');
  }
  await untilLearnt(page); // the page starts the round by itself
  await page.keyboard.press('t');
  await untilLearnt(page, 1);
  const answers = { a: 0, r: 0 };
  for (let i = 0; i < 20 && answers.a + answers.r < 3; ++i) {
    if (!(await page.isEnabled('#people-skip'))) {
      await nextImage(page, 'n');
      await new Promise((later) => setTimeout(later, 200));
      continue;
    }
    const key = answers.a === 0 ? 'a' : 'r';
    const before = (await windowsOf(page)).length;
    await page.keyboard.press(key);
    await until(async () => (await windowsOf(page)).length === before + 1, `answer ${key} is stored`);
    ++answers[key];
  }
  check(answers.a === 1 && answers.r === 2, 'questions were asked');
  const answered = await windowsOf(page);
  check(answered.at(-1).kind === 'not_person', 'a rejected one is kept as nobody');

  await page.keyboard.press('Control+z');
  await until(async () => (await windowsOf(page)).length === answered.length - 1, 'undo takes an answer back');
  await page.keyboard.press('Control+y');
  await until(async () => (await windowsOf(page)).length === answered.length, 'redo brings it again');

  await page.reload();
  await stored(page);
  const reloaded = await labelsOf(page);
  check((await windowsOf(page)).length === answered.length, 'a reload shows the same');
  await page.keyboard.press('m');
  await until(() => imageOf(page), 'an image again');

  // The server dies between the two clicks that draw a person.
  await showImageWithPeople(page, people);
  const [late] = await peopleIn(page, people);
  await page.keyboard.press('d');
  await clickPixel(page, late[0], late[1]);
  await server.kill('SIGKILL');
  await clickPixel(page, late[2], late[3]);
  await until(async () => (await page.textContent('#status')).includes('not saved yet'), 'the page says so');
  await server.start();
  await until(async () => (await windowsOf(page).catch(() => [])).length === answered.length + 1, 'it is stored later');
  const after = await labelsOf(page);
  check(after.filter((l) => l.shape === 'upright' && near(l, late)).length >= 1, 'where it was drawn');
  for (const label of reloaded)
    check(after.some((l) => l.id === label.id && l.version === label.version), `label ${label.id} as it was`);

  // Another user changes a box that is about to be deleted: the page asks, then deletes it.
  await until(() => page.isEnabled('#people-delete'), 'who was drawn is selected');
  const last = (await windowsOf(page)).at(-1);
  let bobs = 0;
  await page.route('**/api/labels/*', async (route) => {
    bobs = await page.evaluate(async ({ id, version }) => {
      const headers = { 'Content-Type': 'application/json' };
      const body = JSON.stringify({ note: 'seen', version, who: 'bob', request: 'b' });
      return (await fetch(`api/labels/${id}`, { method: 'PUT', headers, body })).status;
    }, last);
    await route.continue();
  }, { times: 1 });
  await page.keyboard.press('Delete');
  await until(() => bobs !== 0, 'somebody else has sent a change');
  check(bobs === 200, `which was stored: ${bobs}`);
  await until(() => page.isVisible('#conflict'), 'the conflict is shown');
  check((await windowsOf(page)).at(-1).note === 'seen', 'and nothing is deleted before the answer');
  await page.click('#conflict-mine');
  await until(async () => !(await windowsOf(page)).some((l) => l.id === last.id), 'mine is taken when asked for');
  check((await server.kill('SIGTERM')) === 0, 'the server ends cleanly');
});
