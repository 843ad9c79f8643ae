// Images may arrive in any order. The page shows only the image that it requested last.
import { fetchJson } from '../sync/server';
import { imageName, type ImageName, type PeopleImage } from '../types';

export class LatestImage {
  private asked = 0;
  private came = 0;

  /** Null if another image was requested in the meantime. */
  async fetch(name: ImageName): Promise<PeopleImage | null> {
    const turn = ++this.asked;
    try {
      const image = await fetchJson<PeopleImage>('GET', `api/people/${imageName(name)}`);
      return turn === this.asked ? image : null;
    } finally {
      this.came = Math.max(this.came, turn);
    }
  }

  get isComing(): boolean {
    return this.came < this.asked;
  }
}
