// Another user starts a round: the open question here, and moves of its box by keys, stay until the
// user answers.
import { check, labelsOf, stored, until, withPage } from './browser.mjs';
import { hypothesesOf, isAsked, teach } from './hands.mjs';

const kTellLateMs = 2500; // longer than a round's publishing and a label take
const says = async (page, words) => (await page.textContent('#status')).includes(words);

const send = (page, path, body) =>
  page.evaluate(
    async ([to, json]) => {
      const headers = { 'Content-Type': 'application/json' };
      return (await fetch(to, { method: 'POST', headers, body: JSON.stringify(json) })).status;
    },
    [path, body],
  );

async function round(page) {
  const { round: before } = await hypothesesOf(page);
  check((await send(page, 'api/learn', { kind: 'parking_space' })) < 300, 'a round is asked for elsewhere');
  await until(async () => (await hypothesesOf(page)).round === before + 1, 'the round is published', 120000);
}

// Place of the hypothesis after the keys moved it.
async function putRight(page) {
  const { hypotheses, questions } = await hypothesesOf(page);
  const asked = hypotheses.find((h) => h.index === questions[0]);
  for (let i = 0; i < 4; ++i) await page.keyboard.press('ArrowLeft');
  return [asked.x - 0.2, asked.y];
}

async function acceptedAt(page, [x, y], what) {
  const before = (await labelsOf(page)).length;
  await page.keyboard.press('a');
  await until(async () => (await labelsOf(page)).length === before + 1, 'the answer is stored');
  const last = (await labelsOf(page)).at(-1);
  check(Math.hypot(last.x - x, last.y - y) < 1e-6, what);
}

await withPage(async ({ page, spaces, server, browser }) => {
  await teach(page, spaces.slice(0, 4));

  // A correction by arrows is not lost to a new round, whose question waits for the answer.
  let place = await putRight(page);
  await round(page);
  await until(() => says(page, 'next question is ready'), 'its question waits');
  check(await isAsked(page), 'the older one is still asked');
  await acceptedAt(page, place, 'what arrows made of it is what was accepted');
  await until(() => isAsked(page), 'then the next one comes');

  // Another user starts a round and draws a label between its end and its report.
  const bob = await (await browser.newContext()).newPage();
  await bob.addInitScript((ms) => {
    const listen = EventSource.prototype.addEventListener;
    EventSource.prototype.addEventListener = function (type, listener) {
      const late = (event) => setTimeout(() => listener(event), ms);
      listen.call(this, type, type === 'learning' ? late : listener);
    };
  }, kTellLateMs);
  await bob.goto(server.address);
  await stored(bob);
  await bob.fill('#who', 'bob');
  await bob.keyboard.press('Tab');
  await bob.focus('#map');
  await until(async () => (await bob.textContent('#progress')).includes('questions'), 'bob\'s page knows the round');
  await bob.keyboard.press('n');
  await until(() => isAsked(bob), 'a question is open at bob\'s');
  place = await putRight(bob);
  await round(page);
  const [x, y, heading, length, width] = spaces.at(-1);
  const box = { x: x + 8, y: y + 8, heading, length, width, shape: 'box' };
  const drawn = { ...box, kind: 'parking_space', source: 'drawn', score: 1, note: '', who: 'ann', request: 'late' };
  check((await send(page, 'api/labels', drawn)) < 300, 'ann draws meanwhile');
  await until(async () => (await bob.textContent('#hint')).includes('ann changed'), 'bob\'s page hears of it');
  await bob.waitForTimeout(300);
  check(await isAsked(bob), 'his question stays');
  await until(() => says(bob, 'next question is ready'), 'and the round\'s waits for him', 20000);
  await acceptedAt(bob, place, 'what he made of his is what he accepted');
  await until(() => isAsked(bob), 'then the round\'s comes');
  check((await server.kill('SIGTERM')) === 0, 'the server ends cleanly');
});
