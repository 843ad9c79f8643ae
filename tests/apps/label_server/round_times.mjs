// Measures how long a round of the page takes; run by hand:
//   node round_times.mjs ROADBOOK MAKE_LOT LABEL_UI_FOLDER
// Draws three of 164 spaces, then answers ten questions after each of the first rounds. Prints the
// seconds until the page asks, the time of the round as the page shows it, the processor time over
// all threads of the server, and the number of spaces found.
import { readFileSync } from 'node:fs';
import { until, withPage } from './browser.mjs';

const kRounds = 5;
const kAnswers = 10;

const processorSeconds = (pid) => {
  const fields = readFileSync(`/proc/${pid}/stat`, 'utf8').split(') ')[1].split(' ');
  return (Number(fields[11]) + Number(fields[12])) / 100;
};
const isAsked = async (page) => (await page.textContent('#subject')).startsWith('Is this');
const lastRound = (page) =>
  page.evaluate(async () => {
    const progress = await (await fetch('api/progress')).json();
    return progress.running ? null : (progress.rounds.at(-1) ?? null);
  });
const draw = (page, [x, y, heading, length, width]) =>
  page.evaluate(
    (body) =>
      fetch('api/labels', {
        method: 'POST',
        headers: { 'Content-Type': 'application/json' },
        body: JSON.stringify(body),
      }),
    { x, y, heading, length, width, shape: 'box', kind: 'parking_space', source: 'drawn', score: 1, note: '', who: 'ann', request: `at ${x} ${y}` },
  );

await withPage(
  async ({ page, spaces, server }) => {
    for (const i of [0, 25, 50]) await draw(page, spaces[i]);
    for (let round = 1; round <= kRounds; ++round) {
      const begin = Date.now();
      const before = processorSeconds(server.process.pid);
      await page.keyboard.press('t');
      await until(async () => (await lastRound(page))?.round === round, `round ${round}`, 60000);
      await until(() => isAsked(page), 'a question');
      const wall = (Date.now() - begin) / 1000;
      const processor = processorSeconds(server.process.pid) - before;
      const told = await lastRound(page);
      console.log(
        `round ${round}: ${wall.toFixed(2)} s, told ${told.seconds.toFixed(2)} s, processor ${processor.toFixed(2)} s, found ${told.found}`,
      );
      for (let i = 0; i < kAnswers; ++i) {
        await page.keyboard.press(i % 2 ? 'r' : 'a');
        await page.waitForTimeout(150);
      }
      await page.waitForTimeout(800);
    }
  },
  ['2', '41', '0'],
);
