// A thousand labels on a picture of 10,000 x 10,000 pixels: the page stays quick. Limits are for a busy
// machine that paints without a graphics card; what was measured is printed. Loading is counted in the
// page's own processor time: how much else the machine does is no matter of the page.
import { check, labelsOf, stored, until, withPage } from './browser.mjs';

// Longest and median time between two frames while `keys` are pressed one after another [ms].
async function frames(page, keys) {
  await page.evaluate(() => {
    window.frameTimes = [];
    let last = performance.now();
    const next = (now) => {
      window.frameTimes.push(now - last);
      last = now;
      window.frameTimer = requestAnimationFrame(next);
    };
    window.frameTimer = requestAnimationFrame(next);
  });
  for (const key of keys) {
    await page.keyboard.press(key);
    await page.waitForTimeout(30);
  }
  const times = await page.evaluate(() => {
    cancelAnimationFrame(window.frameTimer);
    return window.frameTimes.sort((a, b) => a - b);
  });
  return { median: times[times.length >> 1], p95: times[Math.floor(times.length * 0.95)] };
}

// A clock of the processor time that the page's main thread takes from now on [ms].
async function processorClock(page) {
  const session = await page.context().newCDPSession(page);
  await session.send('Performance.enable', { timeDomain: 'threadTicks' });
  return async () => {
    const { metrics } = await session.send('Performance.getMetrics');
    return 1000 * metrics.find(({ name }) => name === 'TaskDuration').value;
  };
}

const told = (what, { median, p95 }) => console.log(`${what}: frames ${median.toFixed(0)} ms, 95 % ${p95.toFixed(0)} ms`);

await withPage(
  async ({ page, spaces }) => {
    const added = await page.evaluate(async (boxes) => {
      const labels = boxes.map(([x, y, heading, length, width]) => ({
        x, y, heading, length, width, shape: 'box', kind: 'parking_space', source: 'drawn', score: 1, note: '',
      }));
      const begin = performance.now();
      const response = await fetch('api/labels', {
        method: 'POST',
        headers: { 'Content-Type': 'application/json' },
        body: JSON.stringify({ who: 'ann', request: 'many', labels }),
      });
      const { error } = await response.json();
      return { status: response.status, ms: performance.now() - begin, error };
    }, spaces);
    check(added.status === 200, `${spaces.length} labels stored together in ${added.ms.toFixed(0)} ms ${added.error ?? ''}`);
    const begin = Date.now();
    const taken = await processorClock(page);
    await page.reload();
    await stored(page);
    await page.selectOption('#list-what', 'labels');
    await until(async () => (await page.textContent('#list-count')).startsWith('1000 '), 'all are listed');
    const drawn = await page.locator('#rows .line').count();
    check(drawn > 0 && drawn < 60, `only the rows in sight are in the page: ${drawn}`);
    const bottom = await page.evaluate(() => document.querySelector('#layers').getBoundingClientRect().bottom);
    check(bottom <= 900, 'and what stands below the list is in sight');
    const cpuMs = await taken();
    console.log(`page with 1,000 labels: ${Date.now() - begin} ms, ${cpuMs.toFixed(0)} ms of processor time`);
    check(cpuMs < 1500, 'the page is there soon');
    const all = await frames(page, Array(20).fill('ArrowLeft'));
    told('moving the whole place', all);
    const zoom = await frames(page, [...Array(6).fill('+'), ...Array(20).fill('ArrowRight'), ...Array(6).fill('-')]);
    told('zooming and moving', zoom);
    check(all.median < 100 && zoom.median < 100, 'moving and zooming are fluent');
    await page.focus('#rows');
    await page.keyboard.press('End');
    await page.focus('#map');
    const nudge = await frames(page, Array(20).fill('Shift+ArrowUp'));
    told('nudging a label', nudge);
    check(nudge.median < 100, 'so is nudging');
    await until(async () => (await labelsOf(page)).some((l) => l.version >= 2), 'a nudge is stored');
    const search = Date.now();
    await page.fill('#search', '777');
    await until(async () => /^\d+ labels found/.test(await page.textContent('#list-count')), 'search finds');
    check(Date.now() - search < 1500, `in ${Date.now() - search} ms`);
  },
  ['10', '50', '10000'],
);
