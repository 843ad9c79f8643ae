// What a round learns from, and what a new round leaves alone: the last answer, a skip of an older
// round.
import { check, clickPlace, labelsOf, until, withPage } from './browser.mjs';
import { isAsked, pause, subject, teach } from './hands.mjs';

const roundOf = (page) => page.evaluate(async () => (await (await fetch('api/hypotheses')).json()).round);
const lastRound = (page) => page.evaluate(async () => (await (await fetch('api/progress')).json()).rounds.at(-1));

const questionsLeft = async (page) => Number((await page.textContent('#subject-text')).match(/(\d+) open questions/)[1]);

await withPage(async ({ page, spaces, server }) => {
  await teach(page, spaces.slice(0, 4));
  const first = await lastRound(page);

  // Of both kinds: answers of one kind say nothing of how often a search is right.
  for (const key of ['a', 'r', 'r', 'r']) {
    const before = (await labelsOf(page)).length;
    await page.keyboard.press(key);
    await until(async () => (await labelsOf(page)).length === before + 1, 'an answer is stored');
  }

  // All others are skipped but the last, whose answer is long on its way: the round waits for it.
  while ((await questionsLeft(page)) > 1) {
    const before = await page.textContent('#subject-text');
    await page.keyboard.press('s');
    await until(async () => (await page.textContent('#subject-text')) !== before, 'the next question', 5000);
  }
  await page.route('**/api/labels', async (route) => {
    if (route.request().method() === 'POST') await pause(1500);
    await route.continue();
  });
  await page.keyboard.press('r');
  await until(async () => (await roundOf(page)) === first.round + 1, 'the next round begins by itself', 120000);
  const second = await lastRound(page);
  check(second.negatives === first.negatives + 4, `it learnt from the last answer: ${second.negatives}`);
  await page.unroute('**/api/labels');
  await until(() => isAsked(page), 'a question of the next round', 120000);

  // Answers to earlier searches change the order of questions as they change the shown
  // probabilities.
  await page.selectOption('#list-order', 'uncertain');
  const { hypotheses } = await page.evaluate(async () => (await fetch('api/hypotheses')).json());
  const off = (p) => Math.abs(p - 0.5);
  const shown = [...hypotheses].sort((a, b) => off(a.calibrated) - off(b.calibrated))[0];
  const unshifted = [...hypotheses].sort((a, b) => off(a.probability) - off(b.probability))[0];
  check(shown.index !== unshifted.index, 'the answers have changed which is the least sure');
  await page.evaluate(() => (document.querySelector('#rows').scrollTop = 0));
  const firstRow = () => page.evaluate(() => document.querySelector('#rows .line[data-row="0"]')?.id);
  await until(async () => (await firstRow())?.endsWith(`h${second.round * 1e6 + shown.index}`), 'least sure first, as it is shown', 5000);
  await page.focus('#map');

  // Skips of an earlier round are no steps any more: undo reverts the stored step before them.
  const labels = (await labelsOf(page)).length;
  await page.keyboard.press('Control+z');
  await until(async () => /undone/.test(await page.textContent('#status')), 'undo');
  check((await labelsOf(page)).length === labels - 1, 'undo passes over skips of an older round');
  await page.keyboard.press('Control+z');
  await until(async () => (await labelsOf(page)).length === labels - 2, 'and once more');

  // What was begun before a round is asked for ends before it: an older list does not come after the new.
  const before = await lastRound(page);
  await page.keyboard.press('Escape');
  await page.keyboard.press('Escape');
  await page.keyboard.press('0');
  await pause(400);
  await clickPlace(page, ...spaces[3]);
  await until(async () => /^parking space \d/i.test(await subject(page)), 'a label is selected');
  await page.route('**/api/hypotheses', async (route) => {
    const response = await route.fetch();
    await pause(4000);
    await route.fulfill({ response });
  }, { times: 1 });
  await page.keyboard.press('Delete');
  await page.keyboard.press('t');
  await until(async () => (await lastRound(page)).round === before.round + 1, 'a third round', 120000);
  await until(() => isAsked(page), 'a question of it', 120000);
  await pause(4500);
  // The label that was accepted may stand first by now.
  const shownRound = () => page.evaluate(() => {
    const ids = [...document.querySelectorAll('#rows .line')].map((line) => line.id.match(/h(\d+)$/)?.[1]);
    return Math.floor(Number(ids.find((id) => id)) / 1e6);
  });
  check((await shownRound()) === before.round + 1, 'the list is that of the third round');
  check((await server.kill('SIGTERM')) === 0, 'the server ends cleanly');
});
