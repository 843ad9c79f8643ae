// The labels that were selected or drawn last, in the order in which the labeller did it: one that is
// still on its way to the server has its place already.

export interface Place {
  /** Null until it is stored. */
  id: number | null;
}

const kKept = 50;

export class Trail {
  private places: Place[] = [];

  /** A label was selected; null: one that is not stored yet, whose id the caller gives later. */
  put(id: number | null): Place {
    const last = this.places.at(-1);
    if (last && id !== null && last.id === id) return last;
    const place = { id };
    this.places = [...this.places, place].slice(-kKept);
    return place;
  }

  /** It came to nothing. */
  drop(place: Place): void {
    this.places = this.places.filter((other) => other !== place);
  }

  /** Returns the current places, the oldest first. */
  soFar(): readonly Place[] {
    return this.places;
  }
}
