// Images may arrive in any order. The page shows only the image that it requested last.
import { fetchJson } from '../sync/server';
import { imageName, type ImageName, type PeopleImage } from '../types';

export class LatestImage {
  private requested = 0;
  private answered = 0;

  /** Null if another image was requested in the meantime. */
  async fetch(name: ImageName): Promise<PeopleImage | null> {
    const turn = ++this.requested;
    try {
      const image = await fetchJson<PeopleImage>('GET', `api/people/${imageName(name)}`);
      return turn === this.requested ? image : null;
    } finally {
      this.answered = Math.max(this.answered, turn);
    }
  }

  get isLoading(): boolean {
    return this.answered < this.requested;
  }
}
