// More pages of one browser than it opens connections to a server: all of them work, through one stream of
// events, which the next page takes over when the one that holds it is closed.
import { check, labelsOf, stored, until, withPage } from './browser.mjs';
import { draw, status } from './hands.mjs';

const kPages = 8; // a browser opens six connections to a server

await withPage(async ({ page, spaces, server }) => {
  let streams = 0;
  page.context().on('request', (request) => (streams += request.url().endsWith('api/events') ? 1 : 0));
  const pages = [page];
  while (pages.length < kPages) {
    const next = await page.context().newPage();
    await next.goto(server.address, { timeout: 20000 });
    await stored(next);
    pages.push(next);
  }
  check(streams === 0, 'one stream is enough for all');

  const counted = async (one, n) => (await one.textContent('#progress')).includes(`labels${n},`);
  const last = pages.at(-1);
  await last.bringToFront();
  await last.keyboard.press('d');
  await draw(last, spaces[0]);
  for (const one of pages) await until(() => counted(one, 1), 'every page hears of a label', 10000);

  // The page that holds the stream is closed.
  await page.close();
  await draw(last, spaces[2]);
  for (const one of pages.slice(1)) await until(() => counted(one, 2), 'and the others go on hearing', 10000);
  check(streams === 1, 'through one stream again');

  // All pages learn when a break begins and when it ends.
  await server.kill('SIGKILL');
  for (const one of pages.slice(1)) await until(async () => (await status(one)).includes('does not answer'), 'every page hears of a break', 10000);
  await server.start();
  for (const one of pages.slice(1)) await stored(one);
  check((await labelsOf(last)).length === 2, 'nothing is lost');
  check((await server.kill('SIGTERM')) === 0, 'the server ends cleanly');
});
