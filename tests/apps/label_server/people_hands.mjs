// Actions of a user who labels people, for tests of the page.
import { check, labelsOf, until } from './browser.mjs';

export const windowsOf = async (page) => (await labelsOf(page)).filter((l) => l.shape === 'upright');
export const imageOf = (page) => page.getAttribute('#people-picture', 'data-image');

/** Who is in the image that is shown, as [footU, footV, headU, headV]. */
export async function peopleIn(page, people) {
  const [, t, camera] = (await imageOf(page)).split('/');
  const instant = Number((BigInt(t) - 1400000000000000000n) / 500000000n);
  return people.filter((p) => p[0] === instant && p[1] === Number(camera)).map((p) => p.slice(2));
}

export async function clickPixel(page, u, v) {
  const [x, y] = await page.evaluate(
    ([pu, pv]) => {
      const p = new DOMPoint(pu, pv).matrixTransform(document.querySelector('#people-picture svg').getScreenCTM());
      return [p.x, p.y];
    },
    [u, v],
  );
  await page.mouse.move(x, y);
  await page.mouse.click(x, y);
}

export async function draw(page, [fu, fv, hu, hv]) {
  const before = (await windowsOf(page)).length;
  await clickPixel(page, fu, fv);
  await clickPixel(page, hu, hv);
  await until(async () => (await windowsOf(page)).length === before + 1, 'somebody drawn is stored');
}

export const near = (label, [fu, fv]) => Math.hypot(label.foot[0] - fu, label.foot[1] - fv) < 2;

export async function showImageWithPeople(page, people) {
  for (let i = 0; (await peopleIn(page, people)).length < 2; ++i) {
    check(i < 20, 'an image with people comes');
    const before = await imageOf(page);
    await page.keyboard.press('n');
    await until(async () => (await imageOf(page)) !== before, 'the next image comes');
  }
}

export async function nextImage(page, key) {
  const before = await imageOf(page);
  await page.keyboard.press(key);
  await until(async () => (await imageOf(page)) !== before, 'the next image comes by itself', 60000);
}

/** Until the server learns no more, `rounds` further ones are done, and the page shows the last of them. */
export async function untilLearnt(page, rounds = 0) {
  const overview = () => page.evaluate(async () => (await fetch('api/people')).json());
  const before = (await overview()).round;
  await until(async () => {
    const { running, round } = await overview();
    const shown = await page.textContent('#people-progress');
    return !running && round >= before + rounds && !shown.includes('training') && shown.includes(`round ${round}`);
  }, 'learning ends', 120000);
}
