// Labels a whole car park from nothing with the page's keys and clicks; run by hand:
//   node car_park_labeller.mjs ROADBOOK MAP DRIVE SPACES LABEL_UI_FOLDER OUT_FOLDER [rounds|rows|mixed] [SEED]
// The program labels MAP (use a copy). SPACES is the output of print_spaces or make_lot (then DRIVE
// is -): it replaces the labeller's eyes, never the hands. `rounds` draws three spaces and answers
// questions. `rows` draws the ends of each row and fills it. `mixed` fills one row, then answers
// questions.
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { Labeller, at, best, isAsked, readSpaces, withServer } from './labeller.mjs';

const [program, map, drive, spacesFile, pageFolder, out, way = 'rounds', seed = '1'] = process.argv.slice(2);
const kRight = 0.7; // overlap that looks right
const kMostKeys = 14; // a labeller draws a box again that would need more keys
const kContent = 0.12; // the labeller continues to accept likely hypotheses while at most this share of them is wrong

const spaces = readSpaces(spacesFile);
const boxes = async (me) => (await me.api('labels')).labels.filter((l) => l.kind === 'parking_space' && l.shape === 'box');
const likely = async (me) => (await me.api('hypotheses')).hypotheses.filter((h) => h.probability >= 0.5);
const chosen = (me) => me.page.getAttribute('#rows', 'aria-activedescendant');

async function draw(me, space) {
  await me.bring(space);
  const before = (await boxes(me)).length;
  const [l, w] = [space.length / 2, space.width / 2];
  for (const place of [at(space, -l, -w), at(space, l, -w), at(space, 0, w)]) await me.click(place);
  me.decide();
  await me.wait(async () => (await boxes(me)).length === before + 1, 'a drawn box is stored');
}

/** Keys that put a box on a space: turns, moves, sizes. */
function keysTo(space, box) {
  const turn = (Math.atan(Math.tan(space.heading - box.heading)) * 180) / Math.PI;
  const steps = (value, large, small, names) => {
    const [big, rest] = [Math.trunc(Math.abs(value) / large + 0.25), Math.abs(value)];
    const little = Math.round((rest - big * large) / small);
    return [
      ...Array(big).fill(value > 0 ? names[0] : names[1]),
      ...Array(Math.abs(little)).fill(value > 0 === little > 0 ? names[2] : names[3]),
    ];
  };
  const size = (value, names) => Array(Math.round(Math.abs(value) / 0.05)).fill(value > 0 ? names[0] : names[1]);
  return [
    ...(Math.abs(turn) > 2 ? steps(turn, 10, 1, ['z', 'v', 'x', 'c']) : []),
    ...steps(space.x - box.x, 0.5, 0.05, ['Shift+ArrowRight', 'Shift+ArrowLeft', 'ArrowRight', 'ArrowLeft']),
    ...steps(space.y - box.y, 0.5, 0.05, ['Shift+ArrowUp', 'Shift+ArrowDown', 'ArrowUp', 'ArrowDown']),
    ...size(space.width - box.width, [']', '[']),
    ...size(space.length - box.length, ['}', '{']),
  ];
}

async function answer(me, tally) {
  const index = Number((await chosen(me)).replace('row-h', '')) % 1e6; // the number of the round is in front of it
  const box = (await me.api('hypotheses')).hypotheses.find((h) => h.index === index);
  me.decide();
  const { space, iou } = best(box, spaces);
  const keys = space ? keysTo(space, box) : [];
  const right = iou >= kRight || (iou >= 0.4 && keys.length <= kMostKeys);
  if (right && iou < kRight) {
    for (const key of keys) await me.key(key);
    ++tally.moved;
  }
  ++tally[right ? 'a' : 'r'];
  await me.key(right ? 'a' : 'r');
}

async function questions(me) {
  const tally = { a: 0, r: 0, moved: 0 };
  const { round } = await me.api('hypotheses');
  while ((await me.api('hypotheses')).round === round && (await isAsked(me))) {
    const before = await chosen(me);
    await answer(me, tally);
    await me.wait(async () => (await chosen(me)) !== before, 'the next question');
    await me.rest();
  }
  me.note(`  ${tally.a} accepted (${tally.moved} put right before), ${tally.r} rejected`);
  await me.wait(async () => (await isAsked(me)) && !(await me.api('progress')).running, 'the next round');
  const last = (await me.api('progress')).rounds.at(-1);
  me.note(`round ${last.round}: ${last.seconds.toFixed(1)} s, ${last.found} likely`);
}

/** Looks at all dashed boxes; those that are wrong. */
async function wrongOnes(me) {
  const list = await likely(me);
  me.glance(list.length);
  const wrong = list.filter((h) => best(h, spaces).iou < kRight);
  me.note(`  ${list.length} likely ones, ${wrong.length} of them wrong`);
  return [wrong, wrong.length <= kContent * list.length];
}

async function byRounds(me) {
  const clear = spaces.filter((s) => s.seen > 0.99);
  await me.key('d');
  if (way === 'mixed') await fillRow(me, rowsOf(spaces)[0]);
  else for (const part of [0.1, 0.5, 0.9]) await draw(me, clear[Math.floor(part * clear.length)]);
  await me.key('d');
  await me.shot('drawn');
  await me.key('t');
  await me.wait(() => isAsked(me), 'a question');
  await me.rest();
  await me.shot('question');
  for (let round = 1, content = false; round <= 4 && !content; ++round) {
    if (round > 1) await me.key('n');
    await me.rest();
    await questions(me);
    await me.key('0');
    await me.rest();
    [, content] = await wrongOnes(me);
  }
  await me.shot('before_rest');
  const [wrong] = await wrongOnes(me);
  for (const box of wrong) {
    me.decide();
    await me.click([box.x, box.y]);
    await me.rest(120);
    if (await me.page.isEnabled('#reject')) await me.key('r');
    await me.rest();
    await me.shot('rejected');
    if ((await me.view()).resolution < 0.05) await me.key('0');
    await me.rest();
  }
  const before = (await boxes(me)).length;
  await me.key('Shift+A');
  // On a small place no hypothesis may be left; the page then says so.
  const none = async () => /No likely hypothesis|overlap other/.test(await me.text('#hint'));
  await me.wait(async () => (await boxes(me)).length > before || (await none()), 'all in view');
  await me.rest();
  me.note(`all in view: ${(await boxes(me)).length - before} accepted; ${await me.text('#status')}`);
}

/** Spaces side by side, one row after another. */
function rowsOf(list) {
  const rows = [];
  for (const space of list) {
    const last = rows.at(-1)?.at(-1);
    if (last && Math.hypot(last.x - space.x, last.y - space.y) < 1.3 * space.width) rows.at(-1).push(space);
    else rows.push([space]);
  }
  return rows;
}

/** Draws the ends that are clearly seen and fills what is between; one more at the end by `p`. */
async function fillRow(me, row) {
  const clear = row.filter((s) => s.seen > 0.7);
  await draw(me, clear[0]);
  if (clear.length > 1) await draw(me, clear.at(-1));
  if (clear.length > 2) {
    const before = (await boxes(me)).length;
    await me.key('b');
    me.decide();
    await me.wait(async () => (await boxes(me)).length > before, 'the row is filled');
    me.note(`  a row of ${row.length}: ${await me.text('#status')}`);
    for (let i = row.indexOf(clear.at(-1)) + 1; i < row.length; ++i) {
      const now = (await boxes(me)).length;
      await me.key('p');
      me.decide();
      await me.wait(async () => (await boxes(me)).length > now, 'one more');
    }
  }
  await me.shot('row');
}

async function byRows(me) {
  await me.key('d');
  for (const row of rowsOf(spaces)) {
    await fillRow(me, row);
    await me.key('0');
    await me.rest();
  }
  await me.key('d');
}

async function drawMissed(me) {
  const labelled = await boxes(me);
  const missed = spaces.filter((s) => best(s, labelled).iou < 0.5);
  me.glance(spaces.length);
  me.note(`missed: ${missed.length}`);
  if (missed.length === 0) return;
  await me.key('d');
  for (const space of missed) await draw(me, space);
  await me.key('d');
}

function report(me, labels, seconds) {
  const matched = labels.map((l) => ({ l, ...best(l, spaces) })).filter((m) => m.iou >= 0.5);
  const off = matched.map(({ l, space }) => Math.hypot(space.x - l.x, space.y - l.y)).sort((a, b) => a - b);
  return {
    way, spaces: spaces.length,
    found: spaces.filter((s) => best(s, labels).iou >= 0.5).length,
    labels: labels.length, right: matched.length, looks_right: matched.filter((m) => m.iou >= kRight).length,
    drawn: labels.filter((l) => l.source === 'drawn').length,
    off_median_m: off[Math.floor(off.length / 2)], off_95_m: off[Math.floor(0.95 * off.length)],
    ...me.counts, modelled_s: me.modelled(), waited_s: me.waited, script_s: seconds, log: me.log,
  };
}

await withServer(program, map, drive, pageFolder, { viewport: { width: 1400, height: 900 } }, async (page) => {
  page.on('pageerror', (fault) => console.log(`error in the page: ${fault.message}`));
  await page.waitForFunction(() => 'place' in document.querySelector('#map').dataset);
  const me = new Labeller(page, out, seed);
  await me.shot('start');
  const begin = Date.now();
  await (way === 'rows' ? byRows(me) : byRounds(me));
  await me.shot('taken');
  await drawMissed(me);
  await me.key('0');
  const result = report(me, await boxes(me), (Date.now() - begin) / 1000);
  await me.shot('end');
  console.log(result);
  writeFileSync(join(out, 'result.json'), JSON.stringify(result, null, 1));
});
