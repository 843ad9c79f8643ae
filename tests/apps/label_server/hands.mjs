// Actions of a user at the page that tests repeat.
import { clickPlace, labelsOf, threeClicks, until } from './browser.mjs';

export const pause = (ms) => new Promise((later) => setTimeout(later, ms));
export const subject = (page) => page.textContent('#subject');
export const status = (page) => page.textContent('#status');
export const hint = (page) => page.textContent('#hint');
export const isAsked = async (page) => (await subject(page)).startsWith('Is this');
export const hypothesesOf = (page) => page.evaluate(async () => (await fetch('api/hypotheses')).json());

/** A key so often that the page hears no rest between two presses, however busy the machine is. */
export const quickly = (page, key, times) =>
  Promise.all(Array.from({ length: times }, () => page.keyboard.press(key)));

/** The clicks that draw a box [x, y, heading, length, width], drawing being switched on. */
export async function clickCorners(page, space) {
  for (const corner of threeClicks(space)) await clickPlace(page, ...corner);
}

/** The same, until it is stored. */
export async function draw(page, space) {
  const before = (await labelsOf(page)).length;
  await clickCorners(page, space);
  await until(async () => (await labelsOf(page)).length === before + 1, 'a drawn box is stored');
}

/** Draws boxes and learns from them; a question is open then. */
export async function teach(page, spaces) {
  await page.keyboard.press('d');
  for (const space of spaces) await draw(page, space);
  await page.keyboard.press('d');
  await page.keyboard.press('t');
  await until(() => isAsked(page), 'a question comes', 120000);
}

/** The whole place, at rest. */
export async function showAll(page) {
  await page.keyboard.press('0');
  await pause(400);
}

/** Clicks on the label of that number; again where the view was still on its way to another place. */
export async function select(page, id, [x, y]) {
  const selected = async () => (await subject(page)).endsWith(` ${id}`);
  for (let tries = 0; tries < 2; ++tries) {
    await clickPlace(page, x, y);
    try {
      return await until(selected, `label ${id} is selected`, 3000);
    } catch {
      await pause(500);
    }
  }
  await clickPlace(page, x, y);
  await until(selected, `label ${id} is selected`, 5000);
}

/** Requests of that method and path wait until what this returns is called. */
export async function hold(page, path, method, answer = (route) => route.continue()) {
  let release = () => {};
  const held = new Promise((done) => (release = done));
  await page.route(path, async (route) => {
    if (route.request().method() !== method) return route.fallback();
    await held;
    await answer(route).catch(() => {}); // the page may have been loaded again
  });
  return async () => {
    release();
    await pause(50);
    await page.unroute(path);
  };
}
