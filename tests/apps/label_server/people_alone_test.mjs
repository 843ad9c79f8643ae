// A map without an overhead image: users can label people in its images, and the page says what is
// missing for labels on the ground.
import { check, stored, until, withPage } from './browser.mjs';

await withPage(async ({ page, server }) => {
  await until(() => page.getAttribute('#people-picture', 'data-image'), 'an image comes by itself');
  check(!(await page.isVisible('#map')), 'there is no ground');
  await page.keyboard.press('m');
  await until(async () => (await page.textContent('#hint')).includes('roadbook overhead'), 'the page says what is missing');
  check(!(await page.isVisible('#map')), 'and stays with the people');
  await page.dispatchEvent('#mode-ground', 'click'); // marked as disabled, and says why
  check(!(await page.isVisible('#map')), 'for clicks too');
  const image = await page.getAttribute('#people-picture', 'data-image');
  await page.keyboard.press('Enter');
  await until(async () => (await page.getAttribute('#people-picture', 'data-image')) !== image, 'an image is done');
  await page.reload();
  await stored(page);
  await until(async () => (await page.textContent('#people-progress')).includes('1 '), 'and stays so');
  check((await server.kill('SIGTERM')) === 0, 'the server ends cleanly');
}, ['bare']);
