// Images come in whatever order: what counts is the one that was asked for last.
import { fetchJson } from '../sync/server';
import { imageName, type ImageName, type PeopleImage } from '../types';

export class LatestImage {
  private asked = 0;
  private came = 0;

  /** Null where another was asked for meanwhile. */
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
