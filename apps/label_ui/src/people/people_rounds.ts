// The rounds of learning people: the queue of images, and the time of the next round.
import { fetchJson } from '../sync/server';
import type { PeopleOverview } from '../types';

const kLearnEvery = 8; // images done

export class PeopleRounds {
  overview: PeopleOverview = {
    images: 0, done: 0, persons: 0, learnt_before: 0, running: false, round: 0, rounds: [], queue: [],
  };
  private doneSince = 0;

  constructor(
    private readonly map: string,
    private readonly status: (message: string) => void,
    private readonly warn: (message: string) => void,
    private readonly changed: () => void,
  ) {}

  async refresh(): Promise<void> {
    try {
      this.overview = await fetchJson<PeopleOverview>('GET', 'api/people');
    } catch {
      return; // the status line already reports that the server is not available
    }
    this.changed();
  }

  async learn(): Promise<void> {
    this.doneSince = 0;
    try {
      await fetchJson('POST', 'api/people/learn', { map: this.map });
      this.status('Training');
    } catch (fault) {
      this.warn((fault as Error).message);
    }
  }

  /**
   * Starts the first rounds soon, because each image is very informative. Later rounds wait for
   * more images.
   */
  async imageDone(): Promise<void> {
    ++this.doneSince;
    await this.refresh();
    const { persons, learnt_before, round, running } = this.overview;
    if (persons + learnt_before > 0 && !running && this.doneSince >= Math.min(kLearnEvery, 1 + 2 * round))
      await this.learn();
  }
}
