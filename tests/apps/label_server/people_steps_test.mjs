// Undo and redo of skips, and of moved boxes before their answer, in images of people.
import { check, labelsOf, until, withPage } from './browser.mjs';
import { pause, status } from './hands.mjs';
import { draw, imageOf, nextImage, peopleIn, showImageWithPeople, untilLearnt, windowsOf } from './people_hands.mjs';

const skipped = async (page) => (await page.textContent('#people-list')).includes('skipped');
const outline = async (page) => (await page.locator('#people-picture .casing.marked').getAttribute('points')).split(' ')[0].split(',').map(Number);
const movedBy = async (page, from, by) => {
  const [u, v] = await outline(page);
  return Math.hypot(u - from[0] - by[0], v - from[1] - by[1]) < 0.15; // shown to a tenth of a pixel
};

async function press(page, key, words) {
  await page.evaluate(() => (document.querySelector('#status').textContent = ''));
  await page.keyboard.press(key);
  await until(async () => (await status(page)).includes(words), `${key}: ${words}`, 5000);
}

async function untilAsked(page) {
  for (let i = 0; !(await page.isEnabled('#people-skip')); ++i) {
    check(i < 20, 'somebody is asked about');
    await nextImage(page, 'n');
    await pause(200);
  }
}

await withPage(async ({ page, spaces: people, server }) => {
  await page.keyboard.press('m');
  await until(() => imageOf(page), 'an image comes by itself');
  await showImageWithPeople(page, people);
  await page.keyboard.press('d');
  for (const one of await peopleIn(page, people)) await draw(page, one);
  await page.keyboard.press('d');
  await nextImage(page, 'Enter');
  await until(async () => (await page.textContent('#people-progress')).includes('round 1'), 'a round by itself', 120000);
  await untilLearnt(page);
  await nextImage(page, 'n'); // what came before the round's end was searched by another classifier
  await untilAsked(page);
  const stored = (await windowsOf(page)).length;

  // Keys, each time they rest.
  const begin = await outline(page);
  for (let i = 0; i < 3; ++i) await page.keyboard.press('ArrowRight');
  await pause(500);
  await page.keyboard.press('Shift+ArrowUp');
  check(await movedBy(page, begin, [3, -10]), 'keys move what is asked about');
  await press(page, 'Control+z', 'Move undone');
  check(await movedBy(page, begin, [3, 0]), 'the last keys are taken back');
  await press(page, 'Control+z', 'Move undone');
  check(await movedBy(page, begin, [0, 0]), 'and those before');
  await press(page, 'Control+y', 'Move redone');
  check(await movedBy(page, begin, [3, 0]), 'and done again');

  // A skip, also from the next image.
  const image = await imageOf(page);
  await page.keyboard.press('s');
  await until(() => skipped(page), 'a skip');
  await press(page, 'Control+z', 'Skip undone');
  check(!(await skipped(page)) && (await page.isEnabled('#people-skip')), 'is asked about again');
  check(await movedBy(page, begin, [3, 0]), 'as keys have left it');
  await press(page, 'Control+y', 'Skip redone');
  check(await skipped(page), 'redo skips it');
  await nextImage(page, 'n');
  await page.keyboard.press('m');
  await press(page, 'Control+z', 'Skip undone');
  check((await imageOf(page)) === image && (await page.isVisible('#people-picture')), 'its image is shown again');
  check(await movedBy(page, begin, [3, 0]), 'and it is asked about, as keys have left it');

  // Accepted and undone, the box is where keys moved it, and these moves can be undone too.
  await page.keyboard.press('a');
  await until(async () => (await windowsOf(page)).length === stored + 1, 'an answer is stored');
  await press(page, 'Control+z', 'undone');
  await until(async () => (await windowsOf(page)).length === stored, 'and taken back');
  await until(() => page.isEnabled('#people-skip'), 'it is asked again');
  await press(page, 'Control+z', 'Move undone');
  await until(() => movedBy(page, begin, [0, 0]), 'so are the keys');
  check((await windowsOf(page)).length === stored, 'nothing that was stored before them is');

  // Images come out of turn: the one that was asked for last stays.
  const camera = async () => Number((await imageOf(page)).split('/')[2]);
  const [late, last] = (await camera()) === 0 ? ['2', '1'] : ['1', '2'];
  await page.route('**/api/people/*/*/*', async (route) => {
    await pause(1200);
    await route.continue();
  }, { times: 1 });
  const came = page.waitForResponse((response) => response.url().endsWith(`/${late - 1}`));
  await page.keyboard.press(late);
  await page.keyboard.press(last);
  await came;
  await pause(200);
  check((await camera()) === last - 1, 'what was asked for last is shown');

  // Enter pressed twice before the answer: the image is done once.
  const settled = async () => (await labelsOf(page)).filter((l) => l.shape === 'image').length;
  const done = await settled();
  await until(async () => !(await page.textContent('#people-done')).includes('Next') || (await nextImage(page, 'n')), 'an open image');
  for (const path of ['**/api/people/*/*/*', '**/api/labels'])
    await page.route(path, async (route) => {
      if (route.request().method() !== 'GET' || path.includes('people')) await pause(800);
      await route.continue();
    }, { times: 1 });
  const from = await imageOf(page);
  await page.keyboard.press('Enter');
  await pause(100);
  await page.keyboard.press('Enter');
  await until(async () => (await imageOf(page)) !== from, 'the next image comes');
  await until(async () => (await settled()) > done, 'it is done');
  await pause(1500);
  check((await settled()) === done + 1, 'once');
  const href = await page.locator('#people-picture image').getAttribute('href');
  check(/^api\/image\/[^?]+\?map=\w+$/.test(href), `an image is one of its map: ${href}`);
  check((await server.kill('SIGTERM')) === 0, 'the server ends cleanly');
});
